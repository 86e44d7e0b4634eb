// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What is known of an image's passes. The CPU learns of a pass only after it has submitted others.
#ifndef PassLog_h
#define PassLog_h

#include "GL/SnapshotQueue.h"

#include <cstdint>
#include <vector>

struct TimedPass : glsl::PassRecord
{
  double ElapsedMilliseconds = 0.0; ///< from the start of the image to the end of the pass
};

class PassLog
{
public:
  void StartImage(std::int64_t pixels);
  void AddSubmitted() { ++this->Submitted; }
  /// Records the next submitted pass. Returns null where it had nothing to do.
  const glsl::PassRecord* AddKnown(const Snapshot& snapshot);
  /// One pass, submitted but not known yet, completes the image.
  void AssumeComplete() { this->RemainingRays = 0; }
  /// The image is complete: passes still to come have nothing to do.
  void EndImage() { this->Known = this->Submitted; }
  /// Sets the times of all known passes.
  void SetTimes(const std::vector<double>& milliseconds);

  std::int64_t GetSubmitted() const { return this->Submitted; }
  std::int64_t GetKnown() const { return this->Known; }
  bool AwaitsPasses() const { return this->Known < this->Submitted; }
  /// Live rays after the last known pass.
  std::int64_t GetRemainingRays() const { return this->RemainingRays; }
  /// Did the last known pass ask for blocks in vain?
  bool WasRefusedBlocks() const
  {
    return !this->Passes.empty() && this->Passes.back().RefusedBlocks > 0;
  }
  /// Have many passes in a row neither met, nor decoded, nor finished anything?
  bool IsStuck() const;
  const std::vector<TimedPass>& GetPasses() const { return this->Passes; }

private:
  std::int64_t Submitted = 0;
  std::int64_t Known = 0;
  std::int64_t RemainingRays = 0;
  int PassesWithoutProgress = 0;
  std::vector<TimedPass> Passes;
};

#endif
