// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/UniformBuffers.h"

#include <iterator>
#include <numeric>

namespace
{
// Bytes of the blocks, by their bindings.
constexpr GLsizeiptr BlockBytes[] = { sizeof(glsl::View), sizeof(glsl::Look), sizeof(glsl::Volume),
  sizeof(glsl::Cache) };
}

void UniformBuffers::Initialize()
{
  glGenBuffers(static_cast<GLsizei>(this->Blocks.size()), this->Blocks.data());
  for (std::size_t binding = 0; binding < this->Blocks.size(); ++binding)
  {
    glBindBuffer(GL_UNIFORM_BUFFER, this->Blocks[binding]);
    glBufferData(GL_UNIFORM_BUFFER, BlockBytes[binding], nullptr, GL_DYNAMIC_DRAW);
  }
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

void UniformBuffers::Release()
{
  glDeleteBuffers(static_cast<GLsizei>(this->Blocks.size()), this->Blocks.data());
  this->Blocks.fill(0);
  this->UploadPalette(std::nullopt);
}

void UniformBuffers::Upload(int binding, const void* block)
{
  glBindBuffer(GL_UNIFORM_BUFFER, this->Blocks[binding]);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, BlockBytes[binding], block);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

void UniformBuffers::UploadPalette(const std::optional<glsl::Palette>& palette)
{
  this->PaletteBytes = palette ? static_cast<std::int64_t>(sizeof(glsl::Palette)) : 0;
  if (!palette)
  {
    glDeleteBuffers(1, &this->Palette);
    this->Palette = 0;
    return;
  }
  if (!this->Palette)
  {
    glGenBuffers(1, &this->Palette);
  }
  glBindBuffer(GL_UNIFORM_BUFFER, this->Palette);
  glBufferData(GL_UNIFORM_BUFFER, sizeof(glsl::Palette), &palette.value(), GL_DYNAMIC_DRAW);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

void UniformBuffers::Bind() const
{
  for (std::size_t binding = 0; binding < this->Blocks.size(); ++binding)
  {
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding), this->Blocks[binding]);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, PALETTE_BINDING, this->Palette);
}

void UniformBuffers::Unbind()
{
  for (GLuint binding = 0; binding <= PALETTE_BINDING; ++binding)
  {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, 0);
  }
}

std::int64_t UniformBuffers::GetBlockBytes()
{
  return std::accumulate(std::begin(BlockBytes), std::end(BlockBytes), std::int64_t(0));
}
