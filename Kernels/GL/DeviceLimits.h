// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DeviceLimits_h
#define DeviceLimits_h

#include <cstdint>

/// What an OpenGL context allows, as far as it decides how buffers are made and work is divided.
struct DeviceLimits
{
  std::int64_t LargestBuffer = 0;  ///< bytes of one storage buffer
  std::int64_t DeviceMemory = 0;   ///< bytes of graphics memory; 0: the GPU does not tell
  bool Software = false;           ///< no GPU: Mesa's llvmpipe
  bool SparseBuffers = false;      ///< buffers may be committed page by page, and large ones should
  std::int64_t SparsePage = 0;     ///< bytes of such a page
  bool PersistentMapping = false;  ///< the CPU may see a buffer while the GPU writes it
  bool BackgroundCompiler = false; ///< the driver compiles in threads of its own, and tells when
};

#endif
