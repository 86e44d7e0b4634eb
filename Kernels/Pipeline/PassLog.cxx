// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/PassLog.h"

namespace
{
constexpr int MaximumPassesWithoutProgress = 64;
}

void PassLog::StartImage(std::int64_t pixels)
{
  *this = PassLog();
  this->RemainingRays = pixels;
}

const glsl::PassRecord* PassLog::AddKnown(const Snapshot& snapshot)
{
  ++this->Known;
  const std::size_t total = snapshot.Control.PassIndex;
  if (this->Passes.size() >= total)
  {
    return nullptr;
  }
  TimedPass pass;
  static_cast<glsl::PassRecord&>(pass) = snapshot.Records[(total - 1) % glsl::PASS_RECORDS];
  const bool progress =
    pass.Pairs > 0 || pass.DecodedBlocks > 0 || pass.RemainingRays != this->RemainingRays;
  this->PassesWithoutProgress = progress ? 0 : this->PassesWithoutProgress + 1;
  this->RemainingRays = pass.RemainingRays;
  this->Passes.push_back(pass);
  return &this->Passes.back();
}

void PassLog::SetTimes(const std::vector<double>& milliseconds)
{
  for (std::size_t i = 0; i < milliseconds.size(); ++i)
  {
    this->Passes[i].ElapsedMilliseconds = milliseconds[i];
  }
}

bool PassLog::IsStuck() const
{
  return this->PassesWithoutProgress >= MaximumPassesWithoutProgress;
}
