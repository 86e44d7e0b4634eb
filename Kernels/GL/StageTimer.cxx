// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/StageTimer.h"

#include <utility>

// Places a timestamp behind all commands so far.
StageTimer::Timestamp StageTimer::Mark()
{
  Timestamp timestamp;
  if (this->Software)
  {
    glFinish();
    timestamp.Nanoseconds = static_cast<std::int64_t>(1e6 * this->Clock.GetMilliseconds());
    return timestamp;
  }
  if (this->SpareQueries.empty())
  {
    this->SpareQueries.push_back(0);
    glGenQueries(1, &this->SpareQueries.back());
  }
  timestamp.Query = this->SpareQueries.back();
  this->SpareQueries.pop_back();
  glQueryCounter(timestamp.Query, GL_TIMESTAMP);
  return timestamp;
}

bool StageTimer::HasPassed(const Timestamp& timestamp)
{
  GLint available = 1;
  if (timestamp.Query)
  {
    glGetQueryObjectiv(timestamp.Query, GL_QUERY_RESULT_AVAILABLE, &available);
  }
  return available != 0;
}

double StageTimer::Milliseconds(Timestamp& begin, Timestamp& end)
{
  this->Await(begin);
  this->Await(end);
  return static_cast<double>(end.Nanoseconds - begin.Nanoseconds) * 1e-6;
}

void StageTimer::Await(Timestamp& timestamp)
{
  if (timestamp.Query)
  {
    glGetQueryObjecti64v(timestamp.Query, GL_QUERY_RESULT, &timestamp.Nanoseconds);
    this->Recycle(timestamp);
  }
}

void StageTimer::Recycle(Timestamp& timestamp)
{
  if (timestamp.Query)
  {
    this->SpareQueries.push_back(timestamp.Query);
    timestamp.Query = 0;
  }
}

void StageTimer::RecycleAll()
{
  for (StageRun& run : this->Runs)
  {
    this->Recycle(run.Begin);
    this->Recycle(run.End);
  }
  for (Timestamp& end : this->PassEnds)
  {
    this->Recycle(end);
  }
  this->Recycle(this->ImageStart);
  this->Runs.clear();
  this->PassEnds.clear();
}

void StageTimer::StartImage(const std::set<Stage>& kept)
{
  this->RecycleAll();
  std::map<Stage, double> stages;
  for (const auto& entry : this->Stages)
  {
    if (kept.count(entry.first))
    {
      stages[entry.first] = 0.0;
    }
  }
  this->Stages = std::move(stages);
  this->ImageStart = this->Mark();
}

double StageTimer::GetPreparationMilliseconds()
{
  return HasPassed(this->PreparationEnd)
    ? this->Milliseconds(this->PreparationStart, this->PreparationEnd)
    : 0.0;
}

void StageTimer::EndPass()
{
  this->PassEnds.push_back(this->Mark());
}

void StageTimer::BeginStage(Stage stage)
{
  this->Stages.emplace(stage, 0.0);
  if (this->Detailed)
  {
    this->Runs.push_back({ stage, this->Mark(), Timestamp() });
  }
}

void StageTimer::EndStage()
{
  if (this->Detailed)
  {
    this->Runs.back().End = this->Mark();
  }
}

void StageTimer::Forget()
{
  this->RecycleAll();
  this->Recycle(this->PreparationStart);
  this->Recycle(this->PreparationEnd);
  this->PreparationStart = this->PreparationEnd = Timestamp();
  this->Stages.clear();
}

void StageTimer::Release()
{
  this->Forget();
  glDeleteQueries(static_cast<GLsizei>(this->SpareQueries.size()), this->SpareQueries.data());
  this->SpareQueries.clear();
}

std::vector<double> StageTimer::GetPassEnds(std::size_t passes)
{
  std::vector<double> milliseconds(passes);
  for (std::size_t i = 0; i < passes; ++i)
  {
    milliseconds[i] = this->Milliseconds(this->ImageStart, this->PassEnds[i]);
  }
  return milliseconds;
}

const std::map<Stage, double>& StageTimer::GetStages()
{
  for (StageRun& run : this->Runs)
  {
    this->Stages[run.Id] += this->Milliseconds(run.Begin, run.End);
  }
  this->Runs.clear();
  return this->Stages;
}
