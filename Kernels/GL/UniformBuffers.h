// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The uniform blocks of Shared/SceneBlocks.glsl.h on the GPU, and the palette.
#ifndef UniformBuffers_h
#define UniformBuffers_h

#include "GL/ProgIsoGL.h"
#include "Shaders/Glsl.h"

#include <array>
#include <cstdint>
#include <optional>

class UniformBuffers
{
public:
  void Initialize();
  bool IsInitialized() const { return this->Blocks[0] != 0; }
  void Release();

  ///@{ Each block has its own binding.
  void Upload(const glsl::View& view) { this->Upload(VIEW_BINDING, &view); }
  void Upload(const glsl::Look& look) { this->Upload(LOOK_BINDING, &look); }
  void Upload(const glsl::Volume& volume) { this->Upload(VOLUME_BINDING, &volume); }
  void Upload(const glsl::Cache& cache) { this->Upload(CACHE_BINDING, &cache); }
  ///@}
  /// Colours over a range of values, see Shading.glsl; none frees the buffer.
  void UploadPalette(const std::optional<glsl::Palette>& palette);

  void Bind() const;
  static void Unbind();

  /// Bytes of all blocks but the palette.
  static std::int64_t GetBlockBytes();
  std::int64_t GetPaletteBytes() const { return this->PaletteBytes; }

private:
  void Upload(int binding, const void* block);

  std::array<GLuint, 4> Blocks = {}; ///< by their bindings
  GLuint Palette = 0;
  std::int64_t PaletteBytes = 0;
};

#endif
