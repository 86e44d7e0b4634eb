// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Every stage of the pipeline: its GLSL file, its work group, when it runs, and what it does with
// which buffer. The GLSL that a stage needs for this is generated, see ShaderAssembler.h.
#ifndef StageTable_h
#define StageTable_h

#include "Shaders/BufferTable.h"

#include <cstdint>
#include <string>
#include <vector>

enum class Stage
{
  BlockRanges,
  MarkBlocks,
  MarkCells,
  PlanPass,
  CacheReset,
  CacheUnwind,
  CacheGrow,
  CacheAges,
  CacheEvict,
  CastRays,
  CastStragglers,
  FinishHits,
  RequestBlocks,
  DecodeBlocks,
  DecodeColors,
  Composite,
  Select,
  NumberOfStages
};
constexpr int NumberOfStages = static_cast<int>(Stage::NumberOfStages);

/// When a stage runs.
enum class Moment
{
  Volume,    ///< once, when a volume is loaded
  Isovalues, ///< when they, or the volume, have changed
  Cache,     ///< when the cache is made
  Growth,    ///< when it grows
  Pass,      ///< in every pass
  Drawing    ///< into the window
};

struct StageRun
{
  Moment When;
  Condition Needed;
};

/// When a stage's program must be there. Compiling takes long, so that a driver which compiles in
/// the background does it in this order.
enum class Urgency
{
  AtOnce,  ///< there is no picture without it
  Soon,    ///< passes do without it until it is compiled
  OnDemand ///< only who asks for it waits
};

struct BufferUse
{
  Buffer Id;
  Access How;
  Condition Needed = Conditions::Always; ///< beside the buffer's own
};

/// A dispatch in a pass: the number of work groups is in the control block, at an offset, or one.
constexpr std::ptrdiff_t OneGroup = -1;

struct StageInfo
{
  Stage Id;
  const char* Name;
  const char* File; ///< its GLSL file, below the folder of this header
  int GroupSize;    ///< invocations of a work group; 0: the stage draws
  Urgency Compiled;
  std::ptrdiff_t GroupsInPass;
  std::vector<StageRun> Runs;
  std::vector<BufferUse> Buffers; ///< at most 8 at a time, OpenGL 4.3's guarantee

  bool Draws() const { return this->GroupSize == 0; }
  bool IsNeeded(Moment moment, const SceneNeeds& needs) const;
  bool IsNeeded(const SceneNeeds& needs) const;
  /// What is bound when the stage runs, in the order of their bindings.
  std::vector<Buffer> BuffersOf(const SceneNeeds& needs) const;
  Access AccessTo(Buffer buffer) const;
};

/// The table itself, in the order of the enumeration.
const std::vector<StageInfo>& PipelineStages();
const StageInfo& InfoOf(Stage stage);

/// The stages whose programs are so urgent for a scene, those first that run first.
std::vector<Stage> ProgramsOf(Urgency urgency, const SceneNeeds& needs);

/// Work groups that it takes to give each item an invocation.
std::int64_t GroupsFor(Stage stage, std::int64_t items);

#endif
