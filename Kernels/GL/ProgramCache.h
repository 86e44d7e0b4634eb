// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The compiled stages of an OpenGL context, and the count of its errors. All mappers of a window
// share them. A program is compiled once: where the driver has threads for this, in the background
// from when a scene asks for it, elsewhere when a stage first runs.
#ifndef ProgramCache_h
#define ProgramCache_h

#include "GL/DeviceLimits.h"
#include "GL/ProgIsoGL.h"
#include "GL/Stopwatch.h"
#include "Shaders/ShaderAssembler.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

class Status;

/// What a stage's program took to compile.
struct ProgramTime
{
  Stage Id;
  double Milliseconds = 0.0;       ///< until it was found complete
  double WaitedMilliseconds = 0.0; ///< of these, while nothing else could be done
};

class ProgramCache
{
public:
  /// The programs of the current context, which `contextId` identifies. The caller keeps them
  /// alive; the last owner must call Release() with the context current.
  static std::shared_ptr<ProgramCache> OfContext(
    std::uint64_t contextId, const ShaderDialect& dialect, const DeviceLimits& limits);

  ProgramCache(const ShaderDialect& dialect, bool inBackground);
  ProgramCache(const ProgramCache&) = delete;
  void operator=(const ProgramCache&) = delete;

  /// Has the driver compile stages of a scene, in this order, and returns at once. Without a
  /// compiler in the background it does nothing.
  void Request(const std::vector<Stage>& stages, const SceneNeeds& needs);
  /// Does the driver compile in threads of its own? Some only say so.
  bool CompilesInBackground() const { return this->InBackground; }
  /// Can the scene's stage run without a wait? It is requested if need be. Without a compiler in
  /// the background the answer is always yes, as nothing is won by putting the stage off.
  bool IsReady(Stage stage, const SceneNeeds& needs);
  /// Has a scene's stage been given to somebody?
  bool HasGiven(Stage stage, const SceneNeeds& needs) const;
  /// Gives a scene's stage; waits until it is compiled.
  Status Get(Stage stage, const SceneNeeds& needs, GLuint& program);
  /// Of those programs of a scene that are compiled, in the order of the table.
  std::vector<ProgramTime> GetTimes(const SceneNeeds& needs) const;
  void Release();

  ///@{ OpenGL errors of the context, counted if the environment variable PROGISO_GL_DEBUG is set.
  void CountGLErrors();
  int GetNumberOfGLErrors() const { return this->GLErrors; }
  ///@}

private:
  struct Shader
  {
    GLenum Type;
    AssembledShader Source;
    GLuint Name = 0;
  };
  struct Program
  {
    GLuint Name = 0;
    std::vector<Shader> Shaders; ///< until the program is checked
    Stopwatch SinceRequest;
    ProgramTime Time;
    bool Complete = false;
  };

  Program& Find(Stage stage, const SceneNeeds& needs);
  std::vector<Shader> Assemble(Stage stage, const SceneNeeds& needs) const;
  static void Start(Program& program);
  static void SetComplete(Program& program);
  static Status Check(Program& program);
  void Forget(const Program& program);

  /// By stage and features of the scene.
  std::map<std::pair<Stage, std::uint32_t>, std::shared_ptr<Program>> Programs;
  std::map<std::string, std::shared_ptr<Program>> BySource; ///< scenes may have the same
  ShaderDialect Dialect;
  bool InBackground;    ///< the driver compiles in threads of its own
  int SlowRequests = 0; ///< took so long that the driver seems to compile in them
  bool CountsErrors = false;
  int GLErrors = 0;
};

#endif
