// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Makes complete GLSL sources: what the tables of stages and buffers say, then a file with all
// that it includes. Translates lines in compile errors back to the files and lines of the sources.
#ifndef ShaderAssembler_h
#define ShaderAssembler_h

#include "Shaders/StageTable.h"

#include <map>
#include <string>
#include <vector>

/// Texts of GLSL files by their paths below this folder.
using ShaderFiles = std::map<std::string, const char*>;

/// All GLSL files (generated).
const ShaderFiles& ShaderSources();

/// What an OpenGL context older than 4.3 must offer instead, by name.
const std::vector<std::string>& RequiredExtensions();

/// The GLSL that an OpenGL context understands.
struct ShaderDialect
{
  bool ByExtensions = false; ///< older than 4.3, but with all that we need
  bool Integers64 = false;   ///< of the GPU's own, which are faster than pairs of words
};

/// Lines of a text that come one after the other from a file.
struct ShaderSection
{
  int FirstLine; ///< in the text
  std::string File;
  int FirstLineInFile;
};

struct AssembledShader
{
  std::string Text;
  std::vector<ShaderSection> Sections;
};

/// The vertex shader of all stages that draw.
constexpr const char* ViewportShader = "Output/Viewport.vert";

/// Assembles a file of a stage from
/// - the version: 4.30, or 1.50 with the required extensions; and integers of 64 bits if it can use
///   them,
/// - those of the following macros that it mentions, so that scenes which differ in others only
///   have the same shader:
///   - GROUP_SIZE, and of every stage <STAGE>_GROUP_SIZE,
///   - for each buffer that is bound BUFFER_<X>, the declaration up to its block's name with its
///     qualifiers, and WRITES_<X> if the stage may,
///   - HAS_<X> for each buffer that the scene needs, and a macro for each of its other features,
///   - <X>_SECTION for each section of the buffer of hits, see HitSections.h,
/// - the size of its work group,
/// - the file itself. `#include "X"` pastes X once; `#include BLOCK_ACCESS` the file that knows
///   how this scene's decoded blocks are found.
AssembledShader AssembleShader(const StageInfo& stage, const std::string& file,
  const SceneNeeds& needs, const ShaderDialect& dialect,
  const ShaderFiles& files = ShaderSources());

/// Replaces the places in a shader's text that begin the lines of a compiler's log by file and
/// line. Understands "0:14(5): …" (Mesa) and "0(14) : …" (NVIDIA). No #line directives are needed
/// for this; Mesa forgets the number of the file that they give.
std::string NameFiles(const std::string& log, const AssembledShader& shader);

#endif
