// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Asks OpenGL where every member of the structures of Glsl.h lies in the programs of all stages,
// and compares with C++. A new member has to be entered in the tables here.
#include "GL/Context.h"
#include "GL/ProgIsoGL.h"
#include "GL/ProgramCache.h"
#include "Shaders/Glsl.h"
#include "Shaders/TestWindow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace
{
// Where a member lies; of an array of structures, in its first element.
struct Member
{
  std::size_t Offset;
  std::size_t Stride; // from an element of its array to the next
  std::size_t Bytes;  // in all elements
};
using Members = std::map<std::string, Member>;

// clang-format off
// In the names of OpenGL, but [] for any element.
#define MEMBER(block, member) \
  { #block "." #member, { offsetof(glsl::block, member), 0, sizeof(glsl::block::member) } }
#define ELEMENTS(block, array, member) \
  { #block "." #array "[]." #member, \
    { offsetof(glsl::block, array[0].member), sizeof(glsl::block::array[0]), \
      sizeof(glsl::block::array[0].member) * std::size(glsl::block().array) } }

#define FIXED(block, vector) \
  MEMBER(block, vector.BaseHigh), MEMBER(block, vector.Padding0), \
    MEMBER(block, vector.BaseLow), MEMBER(block, vector.Padding1), \
    MEMBER(block, vector.PerXHigh), MEMBER(block, vector.Padding2), \
    MEMBER(block, vector.PerXLow), MEMBER(block, vector.Padding3), \
    MEMBER(block, vector.PerXLeast), MEMBER(block, vector.Padding4), \
    MEMBER(block, vector.PerYHigh), MEMBER(block, vector.Padding5), \
    MEMBER(block, vector.PerYLow), MEMBER(block, vector.Padding6), \
    MEMBER(block, vector.PerYLeast), MEMBER(block, vector.Padding7)
#define FIXED_ELEMENTS(block, array) \
  ELEMENTS(block, array, BaseHigh), ELEMENTS(block, array, Padding0), \
    ELEMENTS(block, array, BaseLow), ELEMENTS(block, array, Padding1), \
    ELEMENTS(block, array, PerXHigh), ELEMENTS(block, array, Padding2), \
    ELEMENTS(block, array, PerXLow), ELEMENTS(block, array, Padding3), \
    ELEMENTS(block, array, PerXLeast), ELEMENTS(block, array, Padding4), \
    ELEMENTS(block, array, PerYHigh), ELEMENTS(block, array, Padding5), \
    ELEMENTS(block, array, PerYLow), ELEMENTS(block, array, Padding6), \
    ELEMENTS(block, array, PerYLeast), ELEMENTS(block, array, Padding7)

const Members BlockMembers = {
  FIXED(View, RayOrigin), FIXED(View, RayWay),
  MEMBER(View, EyeOrigin.Base), MEMBER(View, EyeOrigin.Padding0),
  MEMBER(View, EyeOrigin.PerX), MEMBER(View, EyeOrigin.Padding1),
  MEMBER(View, EyeOrigin.PerY), MEMBER(View, EyeOrigin.Padding2),
  MEMBER(View, EyeDirection.Base), MEMBER(View, EyeDirection.Padding0),
  MEMBER(View, EyeDirection.PerX), MEMBER(View, EyeDirection.Padding1),
  MEMBER(View, EyeDirection.PerY), MEMBER(View, EyeDirection.Padding2),
  MEMBER(View, CroppingLow.Cell), MEMBER(View, CroppingLow.Padding0),
  MEMBER(View, CroppingLow.Place), MEMBER(View, CroppingLow.Padding1),
  MEMBER(View, CroppingHigh.Cell), MEMBER(View, CroppingHigh.Padding0),
  MEMBER(View, CroppingHigh.Place), MEMBER(View, CroppingHigh.Padding1),
  FIXED_ELEMENTS(View, ClippingOrigin), FIXED_ELEMENTS(View, ClippingWay),
  MEMBER(View, FirstDrawn), MEMBER(View, NumberOfIsovalues),
  MEMBER(View, LastDrawn), MEMBER(View, NumberOfClippingPlanes),
  MEMBER(View, ImageSize), MEMBER(View, FirstPixel), MEMBER(View, ViewportSize),
  MEMBER(View, ViewportOrigin), MEMBER(View, PixelsPerFragment),
  MEMBER(View, NumberOfLevels), MEMBER(View, Padding0), MEMBER(View, DrawnRegions),
  MEMBER(View, HasRays), MEMBER(View, FirstDepth), MEMBER(View, DepthOfWay),
  ELEMENTS(View, Levels, BlendHigh), ELEMENTS(View, Levels, BlendLow),
  ELEMENTS(View, Levels, UntilHigh), ELEMENTS(View, Levels, UntilLow),
  ELEMENTS(View, Levels, FirstWeight), ELEMENTS(View, Levels, LastWeight),
  ELEMENTS(View, Levels, Padding0), ELEMENTS(View, Levels, Padding1),
  ELEMENTS(View, Isovalues, High), ELEMENTS(View, Isovalues, Low),
  ELEMENTS(View, Isovalues, Padding0), ELEMENTS(View, Isovalues, Padding1),

  MEMBER(Look, NormalMatrix),
  MEMBER(Look, ClipZ), MEMBER(Look, ClipZPerT), MEMBER(Look, ClipW), MEMBER(Look, ClipWPerT),
  MEMBER(Look, Ambient), MEMBER(Look, Diffuse), MEMBER(Look, Specular),
  MEMBER(Look, SpecularPower),
  MEMBER(Look, NumberOfLights), MEMBER(Look, LitSides),
  MEMBER(Look, Padding0), MEMBER(Look, Padding1),
  ELEMENTS(Look, Colors, Rgb), ELEMENTS(Look, Colors, Opacity),
  ELEMENTS(Look, Lights, Position), ELEMENTS(Look, Lights, IsPositional),
  ELEMENTS(Look, Lights, Diffuse), ELEMENTS(Look, Lights, ConeExponent),
  ELEMENTS(Look, Lights, ConeAxis), ELEMENTS(Look, Lights, ConeCosine),
  ELEMENTS(Look, Lights, ConstantAttenuation), ELEMENTS(Look, Lights, LinearAttenuation),
  ELEMENTS(Look, Lights, QuadraticAttenuation), ELEMENTS(Look, Lights, IsSpot),
  ELEMENTS(Look, Lights, Specular), ELEMENTS(Look, Lights, Padding0),

  MEMBER(Volume, Samples), MEMBER(Volume, NumberOfBlocks),
  MEMBER(Volume, Blocks), MEMBER(Volume, NumberOfMacrocells),
  MEMBER(Volume, Macrocells), MEMBER(Volume, NumberOfLevels),
  ELEMENTS(Volume, Levels, Samples), ELEMENTS(Volume, Levels, FirstBlock),
  ELEMENTS(Volume, Levels, Blocks), ELEMENTS(Volume, Levels, FirstMacrocell),
  ELEMENTS(Volume, Levels, Macrocells), ELEMENTS(Volume, Levels, Padding0),
  ELEMENTS(Volume, Levels, Halvings), ELEMENTS(Volume, Levels, Padding1),

  MEMBER(Cache, Slots), MEMBER(Cache, MapPages), MEMBER(Cache, CannotGrow),
  MEMBER(Cache, SpeculationLimit), MEMBER(Cache, PixelsPerStraggler),
  MEMBER(Cache, SlotCapacity), MEMBER(Cache, FirstNewSlot), MEMBER(Cache, FirstNewPage),

  MEMBER(Palette, NumberOfNodes), MEMBER(Palette, Tolerance),
  MEMBER(Palette, Padding0), MEMBER(Palette, Padding1),
  MEMBER(Palette, Below), MEMBER(Palette, Above), MEMBER(Palette, None),
  ELEMENTS(Palette, Nodes, Rgb), ELEMENTS(Palette, Nodes, Value),
  { "Palette.Opacities[]", { offsetof(glsl::Palette, Opacities), sizeof(glsl::vec4),
    sizeof(glsl::Palette::Opacities) } },
};

// Of storage buffers: offsets in a block, or in an element of the array that a buffer is.
#define VARIABLE(prefix, structure, member) \
  { prefix #member, offsetof(glsl::structure, member) }
#define DISPATCH(member) \
  VARIABLE("Control.", Control, member.X), VARIABLE("Control.", Control, member.Y), \
    VARIABLE("Control.", Control, member.Z), VARIABLE("Control.", Control, member.Padding0)

const std::map<std::string, std::size_t> StorageMembers = {
  VARIABLE("Control.", Control, Rays), VARIABLE("Control.", Control, WaitingRays),
  VARIABLE("Control.", Control, NextWaitingRays), VARIABLE("Control.", Control, Queue),
  VARIABLE("Control.", Control, FirstNewRay), VARIABLE("Control.", Control, Frontier),
  VARIABLE("Control.", Control, Window), VARIABLE("Control.", Control, FirstLive),
  VARIABLE("Control.", Control, PendingHits), VARIABLE("Control.", Control, PostponedHits),
  VARIABLE("Control.", Control, PassSerial), VARIABLE("Control.", Control, ImageSerial),
  VARIABLE("Control.", Control, PassIndex), VARIABLE("Control.", Control, NewImage),
  VARIABLE("Control.", Control, ActiveRays), VARIABLE("Control.", Control, Pairs),
  VARIABLE("Control.", Control, Requests), VARIABLE("Control.", Control, DeniedRequests),
  VARIABLE("Control.", Control, VisibleBlocks), VARIABLE("Control.", Control, ActiveBlocks),
  VARIABLE("Control.", Control, TouchedSlots), VARIABLE("Control.", Control, FreeSlotsBegin),
  VARIABLE("Control.", Control, FreeSlots), VARIABLE("Control.", Control, ReturnedSlots),
  VARIABLE("Control.", Control, FreePagesBegin), VARIABLE("Control.", Control, FreePages),
  VARIABLE("Control.", Control, TakenPages), VARIABLE("Control.", Control, EvictWanted),
  VARIABLE("Control.", Control, EvictByPages), VARIABLE("Control.", Control, Evicted),
  VARIABLE("Control.", Control, DeniedRequestsBefore),
  VARIABLE("Control.", Control, ContinuingRays), VARIABLE("Control.", Control, NextContinuingRays),
  VARIABLE("Control.", Control, KeptSlotsBegin), VARIABLE("Control.", Control, KeptFreeSlots),
  VARIABLE("Control.", Control, Padding0), DISPATCH(CastGroups), DISPATCH(StragglerGroups),
  DISPATCH(FinishGroups), DISPATCH(RequestGroups), DISPATCH(DecodeGroups), DISPATCH(EvictGroups),
  VARIABLE("Control.", Control, Ages[0]),

  VARIABLE("passRecords[0].", PassRecord, ActiveRays),
  VARIABLE("passRecords[0].", PassRecord, Speculation),
  VARIABLE("passRecords[0].", PassRecord, Pairs),
  VARIABLE("passRecords[0].", PassRecord, VisibleBlocks),
  VARIABLE("passRecords[0].", PassRecord, ActiveBlocks),
  VARIABLE("passRecords[0].", PassRecord, DecodedBlocks),
  VARIABLE("passRecords[0].", PassRecord, CachedBlocks),
  VARIABLE("passRecords[0].", PassRecord, RemainingRays),
  VARIABLE("passRecords[0].", PassRecord, RefusedBlocks),
  VARIABLE("passRecords[0].", PassRecord, TouchedSlots),
  VARIABLE("passRecords[0].", PassRecord, Padding0),
  VARIABLE("passRecords[0].", PassRecord, Padding1),

  VARIABLE("macrocells[0].", Macrocell, Low), VARIABLE("macrocells[0].", Macrocell, High),
  VARIABLE("macrocells[0].", Macrocell, Page), VARIABLE("macrocells[0].", Macrocell, Requested[0]),
  VARIABLE("macrocells[0].", Macrocell, Ranges[0]),

  VARIABLE("mapPages[0].", MapPage, Owner), VARIABLE("mapPages[0].", MapPage, Stamp),
  VARIABLE("mapPages[0].", MapPage, Used), VARIABLE("mapPages[0].", MapPage, Free),
  VARIABLE("mapPages[0].", MapPage, Slots[0]),
};
// clang-format on

// Bytes of an element of the arrays that buffers are.
const std::map<std::string, std::size_t> ElementBytes = { { "passRecords",
                                                            sizeof(glsl::PassRecord) },
  { "macrocells", sizeof(glsl::Macrocell) }, { "mapPages", sizeof(glsl::MapPage) } };

struct Block
{
  int Binding;
  std::size_t Bytes;
};
const std::map<std::string, Block> Blocks = { { "View", { VIEW_BINDING, sizeof(glsl::View) } },
  { "Look", { LOOK_BINDING, sizeof(glsl::Look) } },
  { "Volume", { VOLUME_BINDING, sizeof(glsl::Volume) } },
  { "Cache", { CACHE_BINDING, sizeof(glsl::Cache) } },
  { "Palette", { PALETTE_BINDING, sizeof(glsl::Palette) } } };

// "View.Isovalues[].Low" and 3 from "View.Isovalues[3].Low".
std::string SplitName(const std::string& name, std::size_t& element)
{
  element = 0;
  const std::size_t open = name.find('[');
  if (open == std::string::npos)
  {
    return name;
  }
  element = std::stoul(name.substr(open + 1));
  return name.substr(0, open + 1) + name.substr(name.find(']', open));
}

// A scene that needs every member of every structure.
SceneNeeds EverythingNeeded(bool cached)
{
  SceneNeeds needs;
  needs.Blocks = 64;
  needs.Macrocells = needs.Pixels = needs.Slots = needs.MapPages = needs.HiddenWords = 1;
  needs.HiddenColorWords = 1;
  needs.HiddenCells = true;
  needs.HiddenColors = true;
  needs.Cached = cached;
  needs.Lit = needs.Detailed = needs.SeveralIsovalues = true;
  needs.Translucent = needs.Obstructed = needs.Clipped = needs.Cropped = true;
  needs.Colored = true;
  return needs;
}

class SharedLayout : public TestWithWindow
{
protected:
  void SetUp() override
  {
    TestWithWindow::SetUp();
    ASSERT_TRUE(this->Gl.Open()) << this->Gl.GetStatus().GetMessage();
    this->Programs = std::make_unique<ProgramCache>(this->Gl.GetDialect(), false);
  }
  void TearDown() override { this->Programs->Release(); }

  // The programs of all stages for a scene.
  std::map<std::string, GLuint> Build(const SceneNeeds& needs)
  {
    std::map<std::string, GLuint> programs;
    for (const StageInfo& stage : PipelineStages())
    {
      if (stage.IsNeeded(needs))
      {
        GLuint& program = programs[stage.Name];
        const Status built = this->Programs->Get(stage.Id, needs, program);
        EXPECT_TRUE(built) << built.GetMessage();
      }
    }
    return programs;
  }

  static std::vector<GLint> Ask(
    GLuint program, GLenum interface, GLuint index, const std::vector<GLenum>& properties)
  {
    std::vector<GLint> answers(properties.size());
    glGetProgramResourceiv(program, interface, index, static_cast<GLsizei>(properties.size()),
      properties.data(), static_cast<GLsizei>(answers.size()), nullptr, answers.data());
    return answers;
  }

  static std::string NameOf(GLuint program, GLenum interface, GLuint index)
  {
    char name[256] = {};
    glGetProgramResourceName(program, interface, index, sizeof(name), nullptr, name);
    return name;
  }

  static GLuint CountOf(GLuint program, GLenum interface)
  {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return static_cast<GLuint>(count);
  }

  Context Gl;
  std::unique_ptr<ProgramCache> Programs;
};
}

TEST_F(SharedLayout, UniformBlocksLieAsInCxx)
{
  std::set<std::string> seen;
  for (const auto& [stage, program] : this->Build(EverythingNeeded(true)))
  {
    for (GLuint i = 0; i < CountOf(program, GL_UNIFORM); ++i)
    {
      const std::vector<GLint> answers = Ask(program, GL_UNIFORM, i, { GL_BLOCK_INDEX, GL_OFFSET });
      if (answers[0] < 0)
      {
        continue; // of no block
      }
      std::size_t element = 0;
      const std::string whole = NameOf(program, GL_UNIFORM, i);
      const std::string name = SplitName(whole, element);
      const auto found = BlockMembers.find(name);
      ASSERT_NE(found, BlockMembers.end()) << stage << ": enter " << name << " in BlockMembers";
      EXPECT_EQ(answers[1], found->second.Offset + element * found->second.Stride)
        << stage << ": " << whole;
      seen.insert(name);
    }
  }
  for (const auto& [name, member] : BlockMembers)
  {
    EXPECT_TRUE(seen.count(name)) << name << " is in no program";
  }
}

TEST_F(SharedLayout, UniformBlocksHaveTheSizesAndBindingsOfCxx)
{
  std::set<std::string> seen;
  for (const auto& [stage, program] : this->Build(EverythingNeeded(true)))
  {
    for (GLuint i = 0; i < CountOf(program, GL_UNIFORM_BLOCK); ++i)
    {
      const std::string name = NameOf(program, GL_UNIFORM_BLOCK, i);
      const auto found = Blocks.find(name);
      ASSERT_NE(found, Blocks.end()) << stage << ": enter " << name << " in Blocks";
      const std::vector<GLint> answers =
        Ask(program, GL_UNIFORM_BLOCK, i, { GL_BUFFER_BINDING, GL_BUFFER_DATA_SIZE });
      EXPECT_EQ(answers[0], found->second.Binding) << stage << ": " << name;
      EXPECT_EQ(answers[1], found->second.Bytes) << stage << ": " << name;
      seen.insert(name);
    }
  }
  EXPECT_EQ(seen.size(), Blocks.size());
}

TEST_F(SharedLayout, StorageBuffersLieAsInCxx)
{
  std::set<std::string> seen;
  for (const auto& [stage, program] : this->Build(EverythingNeeded(true)))
  {
    for (GLuint i = 0; i < CountOf(program, GL_BUFFER_VARIABLE); ++i)
    {
      const std::string name = NameOf(program, GL_BUFFER_VARIABLE, i);
      if (name.find('.') == std::string::npos)
      {
        continue; // plain numbers
      }
      const auto found = StorageMembers.find(name);
      ASSERT_NE(found, StorageMembers.end()) << stage << ": enter " << name << " in StorageMembers";
      const std::vector<GLint> answers =
        Ask(program, GL_BUFFER_VARIABLE, i, { GL_OFFSET, GL_TOP_LEVEL_ARRAY_STRIDE });
      EXPECT_EQ(answers[0], found->second) << stage << ": " << name;
      const auto element = ElementBytes.find(name.substr(0, name.find('[')));
      if (element != ElementBytes.end())
      {
        EXPECT_EQ(answers[1], element->second) << stage << ": " << name;
      }
      seen.insert(name);
    }
  }
  for (const auto& [name, offset] : StorageMembers)
  {
    EXPECT_TRUE(seen.count(name)) << name << " is in no program";
  }
}

TEST_F(SharedLayout, MacrocellsWithoutACacheAreAsLargeAsTheTableSays)
{
  const SceneNeeds needs = EverythingNeeded(false);
  const GLuint program = this->Build(needs)["BlockRanges"];
  const GLuint ranges =
    glGetProgramResourceIndex(program, GL_BUFFER_VARIABLE, "macrocells[0].Ranges[0]");
  const std::vector<GLint> answers =
    Ask(program, GL_BUFFER_VARIABLE, ranges, { GL_TOP_LEVEL_ARRAY_STRIDE });
  const BufferInfo& info = PipelineBuffers()[static_cast<std::size_t>(Buffer::Macrocells)];
  EXPECT_EQ(answers[0], info.Bytes(needs));
}

// Blocks are compared and copied byte by byte.
TEST(SharedStructures, HaveNoGaps)
{
  std::map<std::string, std::size_t> bytes;
  for (const auto& [name, member] : BlockMembers)
  {
    bytes[name.substr(0, name.find('.'))] += member.Bytes;
  }
  for (const auto& [name, block] : Blocks)
  {
    EXPECT_EQ(bytes[name], block.Bytes) << name;
  }
}
