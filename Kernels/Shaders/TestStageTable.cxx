// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The tables of stages and buffers say what is: every stage compiles with the access that they
// grant, and not with less.
#include "GL/ProgIsoGL.h"
#include "Shaders/ShaderAssembler.h"
#include "Shaders/TestWindow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace
{
constexpr std::size_t GuaranteedBuffers = 8; // that OpenGL 4.3 lets a stage bind

SceneNeeds SmallScene(bool cached)
{
  SceneNeeds needs;
  needs.Macrocells = needs.Pixels = needs.Slots = needs.MapPages = 1;
  needs.Blocks = 2;
  needs.Cached = cached;
  return needs;
}

SceneNeeds WithAllFeatures(SceneNeeds needs)
{
  needs.HiddenWords = needs.HiddenColorWords = 1;
  needs.Lit = needs.Detailed = needs.HiddenCells = needs.SeveralIsovalues = needs.Obstructed = true;
  needs.HiddenColors = true;
  needs.Clipped = needs.Cropped = needs.Colored = true;
  return needs;
}

SceneNeeds Translucent(SceneNeeds needs)
{
  needs.Translucent = true;
  return needs;
}

SceneNeeds WithCategories(SceneNeeds needs)
{
  needs.Categories = needs.Colored = true;
  return needs;
}

// With ranges, as levels of detail have them.
SceneNeeds WithLevels(SceneNeeds needs, bool conservative)
{
  needs.StoredRanges = needs.Levels = true;
  needs.Conservative = conservative;
  return needs;
}

std::vector<SceneNeeds> Scenes()
{
  std::vector<SceneNeeds> scenes;
  for (const bool conservative : { false, true })
  {
    const SceneNeeds cached = SmallScene(true), decoded = SmallScene(false);
    for (const SceneNeeds& needs :
      { cached, WithAllFeatures(cached), Translucent(cached), decoded, WithAllFeatures(decoded) })
    {
      scenes.push_back(WithLevels(needs, conservative));
    }
  }
  for (const bool cached : { true, false })
  {
    const SceneNeeds plain = SmallScene(cached);
    const SceneNeeds all = WithAllFeatures(plain);
    scenes.insert(
      scenes.end(), { all, plain, Translucent(all), Translucent(plain), WithCategories(plain) });
  }
  return scenes;
}

// Not every compiler tells if an atomic function changes what is only to be read: plain reads and
// writes stand in.
std::string WithoutAtomics(std::string text)
{
  const char* functions[] = { "Add(m, v)", "Or(m, v)", "And(m, v)", "Min(m, v)", "Max(m, v)",
    "Exchange(m, v)", "CompSwap(m, c, v)" };
  for (const char* function : functions)
  {
    const std::size_t line = text.find('\n', text.find("#version")) + 1;
    text.insert(line, std::string("#define atomic") + function + " (m = m + (v))\n");
  }
  return text;
}

AssembledShader Assemble(
  const StageInfo& stage, const SceneNeeds& needs, const ShaderFiles& files = ShaderSources())
{
  return AssembleShader(stage, stage.File, needs, {}, files);
}

// The compiler's log; empty if the shader compiles.
std::string Compile(const StageInfo& stage, const AssembledShader& source)
{
  const GLuint shader = glCreateShader(stage.Draws() ? GL_FRAGMENT_SHADER : GL_COMPUTE_SHADER);
  const char* text = source.Text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  char log[4096] = "no log";
  glGetShaderInfoLog(shader, sizeof(log), nullptr, log);
  glDeleteShader(shader);
  return compiled ? "" : NameFiles(log, source);
}

// Declares a buffer anew with only one kind of access.
std::string WithAccess(std::string text, Buffer buffer, const char* qualifier)
{
  const std::string macro = PipelineBuffers()[static_cast<std::size_t>(buffer)].Macro;
  const std::size_t begin = text.find("restrict", text.find("#define BUFFER_" + macro + " "));
  const std::size_t end = text.find("buffer", begin);
  return begin == std::string::npos ? text : text.replace(begin, end - begin, qualifier);
}

// Is there a scene for which the stage does not compile with this access alone?
bool NeedsMoreThan(const StageInfo& stage, Buffer buffer, const char* qualifier)
{
  const std::vector<SceneNeeds> scenes = Scenes();
  return std::any_of(scenes.begin(), scenes.end(),
    [&](const SceneNeeds& needs)
    {
      AssembledShader source = Assemble(stage, needs);
      source.Text = WithAccess(WithoutAtomics(source.Text), buffer, qualifier);
      return stage.IsNeeded(needs) && !Compile(stage, source).empty();
    });
}

// What a stage defines for the files that it includes.
std::string DefinitionsOf(const StageInfo& stage)
{
  std::istringstream text(ShaderSources().at(stage.File));
  std::string line, definitions;
  while (std::getline(text, line) && line.compare(0, 8, "#include") != 0)
  {
    definitions += line.compare(0, 7, "#define") == 0 ? line + "\n" : "";
  }
  return definitions;
}

// Does a file that the stage includes compile without what else it includes, in some scene?
bool CompilesAlone(const StageInfo& stage, const std::string& file)
{
  const std::vector<SceneNeeds> scenes = Scenes();
  return std::any_of(scenes.begin(), scenes.end(),
    [&](const SceneNeeds& needs)
    {
      const std::vector<ShaderSection> sections = Assemble(stage, needs).Sections;
      const bool included = std::any_of(sections.begin(), sections.end(),
        [&file](const ShaderSection& section) { return section.File == file; });
      AssembledShader shader = AssembleShader(stage, file, needs, {});
      shader.Text.insert(shader.Text.find('\n') + 1, DefinitionsOf(stage));
      return included && Compile(stage, shader).empty();
    });
}

class Shaders : public TestWithWindow
{
};
}

TEST(StageTable, IsInTheOrderOfItsEnumeration)
{
  ASSERT_EQ(PipelineStages().size(), static_cast<std::size_t>(NumberOfStages));
  for (int i = 0; i < NumberOfStages; ++i)
  {
    EXPECT_EQ(static_cast<int>(PipelineStages()[static_cast<std::size_t>(i)].Id), i);
  }
  for (int i = 0; i < NumberOfBuffers; ++i)
  {
    EXPECT_EQ(static_cast<int>(PipelineBuffers()[static_cast<std::size_t>(i)].Id), i);
  }
}

TEST(StageTable, BindsNoMoreBuffersThanGuaranteed)
{
  for (const StageInfo& stage : PipelineStages())
  {
    for (const SceneNeeds& needs : Scenes())
    {
      EXPECT_LE(stage.BuffersOf(needs).size(), GuaranteedBuffers) << stage.Name;
    }
  }
}

TEST(StageTable, EveryProgramIsAskedForOnce)
{
  for (const SceneNeeds& needs : Scenes())
  {
    std::vector<Stage> asked;
    for (const Urgency urgency : { Urgency::AtOnce, Urgency::Soon, Urgency::OnDemand })
    {
      const std::vector<Stage> stages = ProgramsOf(urgency, needs);
      asked.insert(asked.end(), stages.begin(), stages.end());
    }
    std::sort(asked.begin(), asked.end());
    std::vector<Stage> needed;
    for (const StageInfo& stage : PipelineStages())
    {
      if (stage.IsNeeded(needs))
      {
        needed.push_back(stage.Id);
      }
    }
    EXPECT_EQ(asked, needed);
  }
}

// Two programs that decode would take a driver twice as long to compile.
TEST(StageTable, OneStageDecodesTheVolume)
{
  for (const SceneNeeds& needs : Scenes())
  {
    for (const StageInfo& stage : PipelineStages())
    {
      const std::vector<Buffer> bound = stage.BuffersOf(needs);
      const bool decodes = std::count(bound.begin(), bound.end(), Buffer::Stream) > 0;
      EXPECT_EQ(decodes, stage.Id == Stage::DecodeBlocks) << stage.Name;
    }
    EXPECT_EQ(InfoOf(Stage::DecodeBlocks).IsNeeded(Moment::Volume, needs),
      !needs.Cached || !needs.StoredRanges);
  }
}

// Clicks that change how a scene looks do not compile the decoder again.
TEST(ShaderAssembler, DefinesWhatAShaderMentions)
{
  SceneNeeds other = SmallScene(true);
  other.Lit = other.Clipped = other.Cropped = other.SeveralIsovalues = true;
  for (const StageInfo& stage : PipelineStages())
  {
    const bool sees = stage.Id == Stage::CastRays || stage.Id == Stage::CastStragglers ||
      stage.Id == Stage::Composite || stage.Id == Stage::Select || stage.Id == Stage::FinishHits ||
      stage.Id == Stage::RequestBlocks || stage.Id == Stage::PlanPass;
    EXPECT_TRUE(sees || Assemble(stage, other).Text == Assemble(stage, SmallScene(true)).Text)
      << stage.Name;
  }
  const auto defines = [&other](Stage stage, const std::string& name)
  {
    const std::string text = Assemble(InfoOf(stage), other).Text;
    return text.find("#define " + name + "\n") != std::string::npos;
  };
  EXPECT_TRUE(defines(Stage::CastRays, "CLIPPED"));
  EXPECT_FALSE(defines(Stage::DecodeBlocks, "CLIPPED"));
}

TEST_F(Shaders, CompileWithTheAccessOfTheTable)
{
  for (const StageInfo& stage : PipelineStages())
  {
    for (const SceneNeeds& needs : Scenes())
    {
      if (stage.IsNeeded(needs))
      {
        AssembledShader source = Assemble(stage, needs);
        EXPECT_EQ(Compile(stage, source), "") << stage.Name;
        source.Text = WithoutAtomics(source.Text);
        EXPECT_EQ(Compile(stage, source), "") << stage.Name;
      }
    }
  }
}

// As in contexts older than 4.3, such as those that VTK asks EGL for.
TEST_F(Shaders, CompileWithExtensions)
{
  for (const StageInfo& stage : PipelineStages())
  {
    for (const SceneNeeds& needs : Scenes())
    {
      if (stage.IsNeeded(needs))
      {
        const AssembledShader source = AssembleShader(stage, stage.File, needs, { true, false });
        EXPECT_EQ(Compile(stage, source), "") << stage.Name;
      }
    }
  }
}

TEST_F(Shaders, NeedAllTheAccessOfTheTable)
{
  for (const StageInfo& stage : PipelineStages())
  {
    for (const BufferUse& use : stage.Buffers)
    {
      const char* name = PipelineBuffers()[static_cast<std::size_t>(use.Id)].Name;
      EXPECT_TRUE(!Reads(use.How) || NeedsMoreThan(stage, use.Id, "writeonly "))
        << stage.Name << " does not read " << name;
      EXPECT_TRUE(!Writes(use.How) || NeedsMoreThan(stage, use.Id, "readonly "))
        << stage.Name << " does not write " << name;
    }
  }
}

TEST_F(Shaders, FilesIncludeWhatTheyUse)
{
  for (const auto& source : ShaderSources())
  {
    const std::string& file = source.first;
    if (file.substr(file.find('.')) == ".glsl")
    {
      const auto& stages = PipelineStages();
      EXPECT_TRUE(std::any_of(stages.begin(), stages.end(),
        [&file](const StageInfo& stage) { return CompilesAlone(stage, file); }))
        << file;
    }
  }
}

TEST_F(Shaders, ErrorsNameFileAndLine)
{
  ShaderFiles files = ShaderSources();
  const std::string broken =
    std::string(files["Shared/Grid.glsl"]) + "#include \"Rays/Rays.glsl\"\nfloat x = nowhere;\n";
  files["Shared/Grid.glsl"] = broken.c_str();
  const auto lines = std::count(broken.begin(), broken.end(), '\n');
  const std::string log =
    Compile(InfoOf(Stage::CastRays), Assemble(InfoOf(Stage::CastRays), SmallScene(true), files));
  EXPECT_NE(log.find("Shared/Grid.glsl:" + std::to_string(lines)), std::string::npos) << log;
  EXPECT_NE(log.find("nowhere"), std::string::npos) << log;
}

TEST(ShaderAssembler, NamesFilesInLogs)
{
  const AssembledShader shader = { "",
    { { 1, "(generated)", 1 }, { 10, "A.comp", 1 }, { 20, "B.glsl", 1 }, { 30, "A.comp", 12 } } };
  const std::string mesa = "0:33(5): error: no\n";
  EXPECT_EQ(NameFiles(mesa, shader), "A.comp:15: error: no\n");
  const std::string nvidia = "Compute info\n------------\n0(29) : error C1008: no\n";
  EXPECT_EQ(NameFiles(nvidia, shader), "Compute info\n------------\nB.glsl:10 : error C1008: no\n");
}
