// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   BlockStream
 * @brief   a fixed-rate zfp stream in memory, decoded in parallel (internal)
 *
 * Knows a stream by its dimensions, bits per block and memory, and nothing of images or files. A
 * slab is all blocks with the same z. SampleEncoder encodes.
 */
#ifndef BlockStream_h
#define BlockStream_h

#include "Codec/BlockGeometry.h"
#include "Codec/Progress.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

class vtkUnsignedCharArray;
struct SampleSummary;

class BlockStream
{
public:
  struct Block
  {
    vtkTypeInt64 Position[3]; ///< among all blocks
    vtkTypeInt64 Sample;      ///< index of its lowest sample in the volume
    int Size[3];              ///< samples per axis, fewer than 4 at the upper borders
    bool IsWhole() const { return this->Size[0] + this->Size[1] + this->Size[2] == 3 * BlockSide; }
  };

  /**
   * Refers to a stream in `words`, which holds vtkCompressedVolume::StreamBytesFor() bytes, aligned
   * to 8. threads = 0: as many as OpenMP offers.
   */
  BlockStream(const int dims[3], int blockBits, void* words, int threads);

  /**
   * Returns a stream, or a copy if its memory, such as a NumPy array's, is not aligned to 8 bytes.
   */
  static vtkSmartPointer<vtkUnsignedCharArray> Align(vtkUnsignedCharArray* stream);

  const vtkTypeInt64* GetDimensions() const { return this->Dimensions; }
  const vtkTypeInt64* GetBlocks() const { return this->Blocks; }
  vtkTypeInt64 GetBlocksPerSlab() const { return this->Blocks[0] * this->Blocks[1]; }
  vtkTypeInt64 GetNumberOfSlabs() const { return this->Blocks[2]; }
  int GetBlockBits() const { return this->BlockBits; }
  void* GetWords() const { return this->Words; }
  int GetNumberOfThreads() const { return this->Threads; }

  Block GetBlock(vtkTypeInt64 index) const;

  /**
   * Makes of a block the next one, as GetBlock() would, but without its divisions.
   */
  void GoToNext(Block& block) const;

  /**
   * Decodes all blocks to dims[0]*dims[1]*dims[2] floats. Returns false when stopped.
   */
  bool Decode(float* samples, const ProgressCallback& progress) const;

  /**
   * Decodes the blocks [first, last) along each axis, in the calling thread, to a box of
   * 4*(last-first) samples per axis, x fastest. Samples beyond the volume's upper borders are zfp's
   * padding. Threads may share this object.
   */
  void DecodeBox(const int first[3], const int last[3], float* samples) const;

  /**
   * Decodes all blocks to summarise the samples, and keeps none. Returns false when stopped.
   */
  bool Summarize(SampleSummary& summary, const ProgressCallback& progress) const;

  /**
   * Adds a decoded block's samples to a summary, without zfp's padding.
   */
  static void AddTo(SampleSummary& summary, const Block& block, const float samples[BlockSamples]);

private:
  void FindSamples(Block& block) const;

  vtkTypeInt64 Dimensions[3];
  vtkTypeInt64 Blocks[3];
  int BlockBits;
  void* Words;
  int Threads;
};

#endif
