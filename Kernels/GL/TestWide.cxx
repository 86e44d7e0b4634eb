// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Runs the functions of Wide.glsl on random numbers, once with pairs of words and once with
// OpenGL's own integers of 64 bits: both must give the same bits, and those of C++ where it has the
// function.
#include "GL/Context.h"
#include "GL/ProgIsoGL.h"
#include "GL/ProgramCache.h"
#include "Shaders/ShaderAssembler.h"
#include "Shaders/TestWindow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace
{
using Integers = std::array<std::int64_t, 3>;

// What a shader is given and what it returns, in std430's layout.
struct alignas(16) Words
{
  std::int32_t High[4];
  std::uint32_t Low[4];
};

struct Arguments
{
  Words A, B;
};

constexpr int Cases = 4096;

Words WordsOf(const Integers& values)
{
  Words words = {};
  for (int i = 0; i < 3; ++i)
  {
    words.High[i] = static_cast<std::int32_t>(values[i] >> 32);
    words.Low[i] = static_cast<std::uint32_t>(values[i]);
  }
  return words;
}

Integers IntegersOf(const Words& words)
{
  Integers values = {};
  for (int i = 0; i < 3; ++i)
  {
    values[i] = static_cast<std::int64_t>(
      static_cast<std::uint64_t>(static_cast<std::uint32_t>(words.High[i])) << 32 | words.Low[i]);
  }
  return values;
}

// Of an expression in a, b (Wide3), n (ivec3 from 0 to 63) and m (uvec3), which is a Wide3.
std::string ShaderText(const std::string& expression, bool integers64)
{
  const std::string extension =
    integers64 ? "#extension GL_ARB_gpu_shader_int64 : require\n#define NATIVE_INT64\n" : "";
  return "#version 430\n" + extension + "layout(local_size_x = 64) in;\n" +
    ShaderSources().at("Shared/Wide.glsl") + R"(
struct Words { ivec4 High; uvec4 Low; };
struct Arguments { Words A, B; };
layout(std430, binding = 0) readonly buffer Given { Arguments given[]; };
layout(std430, binding = 1) writeonly buffer Results { Words results[]; };
void main()
{
  uint i = gl_GlobalInvocationID.x;
  Wide3 a = WideOf(given[i].A.High.xyz, given[i].A.Low.xyz);
  Wide3 b = WideOf(given[i].B.High.xyz, given[i].B.Low.xyz);
  ivec3 n = ivec3(given[i].B.Low.xyz & 63u);
  uvec3 m = given[i].B.Low.xyz;
  Wide3 result = )" +
    expression + R"(;
  results[i] = Words(ivec4(HighOf(result), 0), uvec4(LowOf(result), 0u));
}
)";
}

// Random numbers of up to so many bits of any size, the difference of two of which does not wrap.
std::vector<Arguments> RandomArguments(int bits, bool negative)
{
  std::mt19937_64 random(bits);
  std::vector<Arguments> given(Cases);
  const auto draw = [&]
  {
    Integers values;
    for (std::int64_t& value : values)
    {
      value = static_cast<std::int64_t>(random() >> (64 - bits + random() % 8 * (bits / 8)));
      value = negative && random() % 2 ? -value : value;
    }
    return WordsOf(values);
  };
  for (Arguments& arguments : given)
  {
    arguments = { draw(), draw() };
    arguments.B = random() % 4 ? arguments.B : arguments.A; // some are equal
  }
  return given;
}

class WideNumbers : public TestWithWindow
{
protected:
  void SetUp() override
  {
    TestWithWindow::SetUp();
    ASSERT_TRUE(this->Gl.Open()) << this->Gl.GetStatus().GetMessage();
  }

  static GLuint Compile(const std::string& source)
  {
    const char* text = source.c_str();
    const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
    char log[2048] = {};
    glGetProgramInfoLog(program, sizeof(log), nullptr, log);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    EXPECT_TRUE(linked) << log << source;
    return program;
  }

  static std::vector<Words> Run(const std::string& source, const std::vector<Arguments>& given)
  {
    const GLuint program = Compile(source);
    std::vector<Words> results(given.size());
    GLuint buffers[2] = {};
    glGenBuffers(2, buffers);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
    glBufferData(GL_SHADER_STORAGE_BUFFER,
      static_cast<GLsizeiptr>(given.size() * sizeof(Arguments)), given.data(), GL_STATIC_DRAW);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[1]);
    const auto bytes = static_cast<GLsizeiptr>(results.size() * sizeof(Words));
    glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_STATIC_READ);
    glUseProgram(program);
    glDispatchCompute(Cases / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, bytes, results.data());
    glUseProgram(0);
    glDeleteBuffers(2, buffers);
    glDeleteProgram(program);
    return results;
  }

  // Both kinds of numbers give the same; returned for what C++ says.
  static std::vector<Integers> Evaluate(
    const std::string& expression, const std::vector<Arguments>& given)
  {
    const std::vector<Words> pairs = Run(ShaderText(expression, false), given);
    const std::vector<Words> own = Run(ShaderText(expression, true), given);
    EXPECT_EQ(0, std::memcmp(pairs.data(), own.data(), pairs.size() * sizeof(Words))) << expression;
    std::vector<Integers> values(pairs.size());
    std::transform(pairs.begin(), pairs.end(), values.begin(), IntegersOf);
    return values;
  }

  static void Compare(const std::string& expression, const std::vector<Arguments>& given,
    const std::function<std::int64_t(std::int64_t, std::int64_t)>& expected)
  {
    const std::vector<Integers> results = Evaluate(expression, given);
    for (std::size_t i = 0; i < given.size(); ++i)
    {
      const Integers a = IntegersOf(given[i].A), b = IntegersOf(given[i].B);
      for (int axis = 0; axis < 3; ++axis)
      {
        ASSERT_EQ(results[i][axis], expected(a[axis], b[axis]))
          << expression << " of " << a[axis] << " and " << b[axis];
      }
    }
  }

  Context Gl;
};

std::uint64_t Unsigned(std::int64_t a)
{
  return static_cast<std::uint64_t>(a);
}

std::int64_t Signed(std::uint64_t a)
{
  return static_cast<std::int64_t>(a);
}
}

TEST_F(WideNumbers, AddAndCompareAsInCxx)
{
  const std::vector<Arguments> given = RandomArguments(62, true);
  const auto compare = [&given](const char* expression, const auto& expected)
  { Compare(expression, given, expected); };
  compare("Sum(a, b)", [](auto a, auto b) { return Signed(Unsigned(a) + Unsigned(b)); });
  compare("Difference(a, b)", [](auto a, auto b) { return Signed(Unsigned(a) - Unsigned(b)); });
  compare("SmallerOf(a, b)", [](auto a, auto b) { return std::min(a, b); });
  compare("LargerOf(a, b)", [](auto a, auto b) { return std::max(a, b); });
  compare("Negated(a, AreNegative(b))", [](auto a, auto b) { return b < 0 ? -a : a; });
  compare("Choose(a, b, AreNegative(b))", [](auto a, auto b) { return b < 0 ? b : a; });
  compare("Masked(a, AreNegative(b))", [](auto a, auto b) { return b < 0 ? a : 0; });
  compare("Flipped(a, b)", [](auto a, auto b) { return a ^ b; });
  compare("Masked(a, -ivec3(AreLess(a, b)))", [](auto a, auto b) { return a < b ? a : 0; });
}

TEST_F(WideNumbers, TellTheLeastOfThree)
{
  const std::vector<Arguments> given = RandomArguments(62, true);
  const std::vector<Integers> least = Evaluate("AllOf(SmallestOf(a))", given);
  const std::vector<Integers> largest = Evaluate("AllOf(LargestOf(a))", given);
  const std::vector<Integers> reached = Evaluate("Masked(a, AreReached(a, SmallestOf(b)))", given);
  const std::vector<Integers> equal =
    Evaluate("Masked(a, -ivec3(AreEqual(a, SmallestOf(b))))", given);
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    const Integers a = IntegersOf(given[i].A), b = IntegersOf(given[i].B);
    const std::int64_t of = *std::min_element(b.begin(), b.end());
    ASSERT_EQ(least[i][0], *std::min_element(a.begin(), a.end()));
    ASSERT_EQ(largest[i][0], *std::max_element(a.begin(), a.end()));
    for (int axis = 0; axis < 3; ++axis)
    {
      ASSERT_EQ(reached[i][axis], a[axis] <= of ? a[axis] : 0);
      ASSERT_EQ(equal[i][axis], a[axis] == of ? a[axis] : 0);
    }
  }
}

TEST_F(WideNumbers, ShiftAndMultiplyAsInCxx)
{
  const std::vector<Arguments> given = RandomArguments(62, true);
  const auto compare = [&given](const char* expression, const auto& expected)
  { Compare(expression, given, expected); };
  compare("ShiftLeft(a, n)", [](auto a, auto b) { return Signed(Unsigned(a) << (b & 63)); });
  compare("ShiftRight(a, n)", [](auto a, auto b) { return Signed(Unsigned(a) >> (b & 63)); });
  compare("Doubled(a, 3)", [](auto a, auto) { return Signed(Unsigned(a) << 3); });
  compare("Product(a, m)",
    [](auto a, auto b) { return Signed(Unsigned(a) * (Unsigned(b) & 0xFFFFFFFFu)); });
  Compare("Halved(a, 3)", RandomArguments(62, false), [](auto a, auto) { return a >> 3; });
}

TEST_F(WideNumbers, MultiplyAndDivideAlike)
{
  const std::vector<Arguments> given = RandomArguments(63, false);
  const std::vector<Integers> products = Evaluate("HighProduct(a, b)", given);
  const std::vector<Integers> inverses =
    Evaluate("Reciprocal(ShiftLeft(a, LeadingZeros(LargerOf(a, AllOf(WIDE(0, 1u))))))", given);
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    const Integers a = IntegersOf(given[i].A), b = IntegersOf(given[i].B);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double product = std::ldexp(static_cast<double>(a[axis]), -64) * b[axis];
      ASSERT_NEAR(static_cast<double>(products[i][axis]), product, 3.0 + 1e-15 * product);
      if (a[axis] > 0)
      {
        int exponent = 0;
        const double leading = std::frexp(static_cast<double>(a[axis]), &exponent);
        const double inverse = std::ldexp(1.0 / leading, 62); // 2^126 / (leading 2^64)
        ASSERT_NEAR(static_cast<double>(Unsigned(inverses[i][axis])), inverse, 1e-14 * inverse);
      }
    }
  }
}

TEST_F(WideNumbers, BecomeTheSameFloats)
{
  Evaluate("WideOf(ivec3(0), floatBitsToUint(ToFloat(a)))", RandomArguments(62, true));
  const std::vector<Arguments> given = RandomArguments(54, false);
  const std::vector<Integers> back = Evaluate("AllOf(ToWide(ToFloat(a).x))", given);
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    const auto a = static_cast<double>(IntegersOf(given[i].A)[0]);
    ASSERT_NEAR(static_cast<double>(back[i][0]), a, 1.0 + 2e-7 * a);
  }
}

TEST_F(WideNumbers, AreUnderstoodInAllStages)
{
  SceneNeeds needs;
  needs.Blocks = needs.Macrocells = needs.Pixels = needs.Slots = needs.MapPages = 1;
  for (const bool cached : { false, true })
  {
    needs.Cached = needs.Lit = needs.Clipped = needs.Cropped = needs.Translucent = cached;
    ProgramCache programs({ false, true }, false);
    for (const StageInfo& stage : PipelineStages())
    {
      GLuint program = 0;
      const Status built =
        stage.IsNeeded(needs) ? programs.Get(stage.Id, needs, program) : Status();
      EXPECT_TRUE(built) << built.GetMessage();
    }
    programs.Release();
  }
}
