// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// docs/reference/buffers.md is what the tables of stages and buffers say. After a change of those,
// PROGISO_WRITE_REFERENCE=1 TestKernels --gtest_filter=ReferencePage.* writes it anew.
#include "Shaders/StageTable.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace
{
constexpr const char* Page = PROGISO_SOURCE_DIR "/docs/reference/buffers.md";

constexpr const char* Introduction =
  R"(<!-- Generated from StageTable.cxx and BufferTable.cxx by TestReferencePage.cxx. -->
# GPU buffers and stages

The stages of the pipeline exchange what they find in these buffers. A buffer that the scene does
not need is not there, and the code that uses it is not compiled; a stage that it does not need does
not run.

## Buffers

Bytes are for *P* pixels of the image, *B* blocks in whole macrocells, and *S* cache slots. The
host is C++.

| buffer | bytes | needed | written by | read by | purpose |
|---|---|---|---|---|---|
)";

constexpr const char* BetweenTables = R"(
Beside these there are the uniform blocks (`scene`), the colours of another volume (`palette`), and
what passes between CPU and GPU (`staging`): under 40 KB.

## Stages

A pass runs those that are needed in every pass, in the order of `ProgressivePipeline::RunPass`.
Where the driver compiles in the background it is given the programs of a scene in the order of the
column *compiled*: there is no picture without those compiled first; passes do without those
compiled second, after the first picture, until they are there; the last are compiled when they are
asked for, or when the image is complete in a window that someone watches.

| stage | file | work group | compiled | runs | reads | writes |
|---|---|---|---|---|---|---|
)";

std::string Joined(const std::vector<std::string>& items)
{
  std::string text;
  for (const std::string& item : items)
  {
    text += (text.empty() ? "" : ", ") + item;
  }
  return text;
}

// Who uses a buffer in this way.
std::string Users(const BufferInfo& buffer, bool (*uses)(Access))
{
  std::vector<std::string> users;
  for (const StageInfo& stage : PipelineStages())
  {
    if (uses(stage.AccessTo(buffer.Id)))
    {
      users.emplace_back(stage.Name);
    }
  }
  if (uses(buffer.Host))
  {
    users.emplace_back("host");
  }
  return Joined(users);
}

// Nothing if the condition always holds.
std::string InBrackets(const Condition& condition)
{
  const std::string words = condition.Words;
  return words == Conditions::Always.Words ? "" : " (" + words + ")";
}

std::string BuffersOf(const StageInfo& stage, bool (*uses)(Access))
{
  std::vector<std::string> names;
  for (const BufferUse& use : stage.Buffers)
  {
    if (uses(use.How))
    {
      names.push_back(std::string("`") + PipelineBuffers()[static_cast<std::size_t>(use.Id)].Name +
        "`" + InBrackets(use.Needed));
    }
  }
  return Joined(names);
}

std::string RunsOf(const StageInfo& stage)
{
  const char* moments[] = { "once a volume", "when isovalues change", "when the cache is made",
    "when it grows", "every pass", "to draw" };
  std::vector<std::string> runs;
  for (const StageRun& run : stage.Runs)
  {
    runs.push_back(moments[static_cast<int>(run.When)] + InBrackets(run.Needed));
  }
  return Joined(runs);
}

std::string ReferencePage()
{
  std::ostringstream out;
  out << Introduction;
  for (const BufferInfo& info : PipelineBuffers())
  {
    out << "| `" << info.Name << "` | " << info.Size << " | " << info.Needed.Words << " | "
        << Users(info, Writes) << " | " << Users(info, Reads) << " | " << info.Purpose << " |\n";
  }
  out << BetweenTables;
  const char* urgencies[] = { "first", "second", "last" };
  for (const StageInfo& stage : PipelineStages())
  {
    out << "| " << stage.Name << " | [" << stage.File << "](../../Kernels/Shaders/" << stage.File
        << ") | " << (stage.Draws() ? "" : std::to_string(stage.GroupSize)) << " | "
        << urgencies[static_cast<int>(stage.Compiled)] << " | " << RunsOf(stage) << " | "
        << BuffersOf(stage, Reads) << " | " << BuffersOf(stage, Writes) << " |\n";
  }
  return out.str();
}
}

TEST(ReferencePage, IsWhatTheTablesSay)
{
  if (std::getenv("PROGISO_WRITE_REFERENCE"))
  {
    std::ofstream(Page) << ReferencePage();
  }
  std::ostringstream page;
  page << std::ifstream(Page).rdbuf();
  EXPECT_EQ(page.str(), ReferencePage());
}
