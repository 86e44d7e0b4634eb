// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Times the passes of an image and, on demand, its stages, by timestamps in the stream of commands.
#ifndef StageTimer_h
#define StageTimer_h

#include "GL/ProgIsoGL.h"
#include "GL/Stopwatch.h"
#include "Shaders/StageTable.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

class StageTimer
{
public:
  /// Software renderers have no credible timer queries; there, a timestamp waits for all commands.
  void SetSoftware(bool software) { this->Software = software; }
  /// Whether stages are timed, too.
  void SetDetailed(bool detailed) { this->Detailed = detailed; }

  /// Starts an image. Stages that ran before are forgotten, except those that prepared its volume;
  /// their time is not part of the image's.
  void StartImage(const std::set<Stage>& kept);
  void EndPass();
  void BeginStage(Stage stage);
  void EndStage();
  ///@{ Times what prepares a volume, apart from its images.
  void BeginPreparation() { this->PreparationStart = this->Mark(); }
  void EndPreparation() { this->PreparationEnd = this->Mark(); }
  /// 0 until the GPU has come so far.
  double GetPreparationMilliseconds();
  ///@}
  /// Forgets all that has run.
  void Forget();
  void Release();

  /// Milliseconds from the start of the image to the ends of so many passes. Waits for the GPU.
  std::vector<double> GetPassEnds(std::size_t passes);
  /// The stages that ran, with their milliseconds if they are timed, else 0. Waits for the GPU.
  const std::map<Stage, double>& GetStages();

private:
  struct Timestamp
  {
    GLuint Query = 0;             ///< 0: the time is known
    std::int64_t Nanoseconds = 0; ///< on the GPU's clock, or on the stopwatch
  };
  struct StageRun
  {
    Stage Id;
    Timestamp Begin, End;
  };

  Timestamp Mark();
  static bool HasPassed(const Timestamp& timestamp);
  double Milliseconds(Timestamp& begin, Timestamp& end);
  void Await(Timestamp& timestamp);
  void Recycle(Timestamp& timestamp);
  void RecycleAll();

  bool Software = false;
  bool Detailed = false;
  Stopwatch Clock;
  std::vector<GLuint> SpareQueries;
  Timestamp PreparationStart, PreparationEnd;
  Timestamp ImageStart;
  std::vector<Timestamp> PassEnds;
  std::vector<StageRun> Runs; ///< not yet added up
  std::map<Stage, double> Stages;
};

#endif
