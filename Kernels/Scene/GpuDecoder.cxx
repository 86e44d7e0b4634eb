// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/GpuDecoder.h"

#include "Scene/BoundWindow.h"
#include "Scene/CompressedInput.h"
#include "Shaders/Glsl.h"

#include "vtkCompressedVolume.h"
#include "vtkFloatArray.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"

#include <cstdint>
#include <vector>

namespace
{
// Copies the samples of blocks in x-fastest order.
void CopyBlocks(
  const std::vector<float>& blockValues, vtkCompressedVolume* volume, vtkFloatArray* samples)
{
  int dims[3], blocks[3];
  volume->GetDimensions(dims);
  volume->GetBlocks(blocks);
  samples->SetNumberOfComponents(1);
  samples->SetNumberOfTuples(static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2]);
  constexpr int side = glsl::BLOCK_SIDE;
  vtkIdType sample = 0;
  for (int z = 0; z < dims[2]; ++z)
  {
    for (int y = 0; y < dims[1]; ++y)
    {
      for (int x = 0; x < dims[0]; ++x)
      {
        const std::int64_t block =
          x / side + blocks[0] * (y / side + static_cast<std::int64_t>(blocks[1]) * (z / side));
        const int inBlock = x % side + side * (y % side + side * (z % side));
        samples->SetValue(sample++, blockValues[glsl::SAMPLES_PER_BLOCK * block + inBlock]);
      }
    }
  }
}
}

Status DecodeOnGPU(
  vtkOpenGLRenderWindow* window, vtkCompressedVolume* volume, vtkFloatArray* samples)
{
  window->Initialize();
  window->MakeCurrent();
  window->GetShaderCache()->ReleaseCurrentShader();
  ProgressivePipeline pipeline;
  std::vector<float> blockValues;
  Status status = pipeline.Initialize(BoundWindow::ContextOf(window));
  if (status)
  {
    pipeline.SetVolume(DescribeVolume(volume));
    status = pipeline.DecodeVolume(blockValues);
  }
  pipeline.Release();
  glUseProgram(0);
  if (status)
  {
    CopyBlocks(blockValues, volume, samples);
  }
  return status;
}
