// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPBlocks
 * @brief   encode and decode runs of blocks of a fixed-rate zfp stream in parallel (internal)
 *
 * Knows a stream of 4x4x4 blocks by its dimensions, bits per block and memory, and nothing of
 * images or files. A layer is all blocks with the same z.
 *
 * Why not zfp_compress() with zfp's OpenMP policy: that encodes into one buffer per thread, which
 * one thread concatenates, and it has no parallel decoder. 64 blocks always fill whole 64-bit words
 * (64*BlockBits bits), so threads that take blocks in groups of 64 write in place, and decode
 * alike.
 */
#ifndef vtkZFPBlocks_h
#define vtkZFPBlocks_h

#include "vtkBlockMask.h"
#include "vtkSmartPointer.h" // for the stream
#include "vtkType.h"

#include <array>      // for the range
#include <functional> // for progress
#include <limits>     // for the empty range
#include <string>     // for what is wrong with values

class vtkAlgorithm;
class vtkDataArray;
class vtkUnsignedCharArray;

class vtkZFPBlocks
{
public:
  /**
   * What was seen of the samples of some blocks.
   */
  struct Summary
  {
    float Minimum = std::numeric_limits<float>::infinity();
    float Maximum = -std::numeric_limits<float>::infinity();
    vtkTypeInt64 NaNs = 0;
    vtkTypeInt64 Infinities = 0;
    vtkTypeInt64 TinyBlocks = 0; ///< blocks encoded as zero, see Encode()

    /// Minimum and maximum; zeros where nothing was seen.
    std::array<double, 2> GetRange() const;
    bool IsFinite() const { return this->NaNs == 0 && this->Infinities == 0; }
    float Magnitude() const; ///< largest absolute value
    void Add(float value);
    void AddBlock(const float samples[64]);
    void Add(const Summary& other);

    /**
     * What zfp cannot represent among the values, as the end of a sentence that begins with what
     * has them; empty when there is nothing.
     */
    std::string GetObjection() const;
  };

  /**
   * A stream in `words`, which holds vtkCompressedVolume::StreamBytesFor() bytes, aligned to 8.
   * threads = 0: as many as OpenMP offers.
   */
  vtkZFPBlocks(const int dims[3], int blockBits, void* words, int threads);

  /**
   * A stream, or a copy where its memory (someone's NumPy array) is not aligned to 64-bit words.
   */
  static vtkSmartPointer<vtkUnsignedCharArray> Align(vtkUnsignedCharArray* stream);

  /**
   * Called now and then, by the calling thread, with the fraction done; false stops the work.
   */
  using Report = std::function<bool(double)>;

  /**
   * Reports the progress of an algorithm, and stops when that is aborted.
   */
  static Report ReportOf(vtkAlgorithm* algorithm);

  /**
   * Samples that are not to be seen: which, and the mask that was made of them. They get values
   * that cost zfp little, and a summary leaves them out.
   */
  struct Hidden
  {
    const unsigned char* Flags = nullptr; ///< of every tuple; null: none has any
    unsigned char Hiding = 0;             ///< flags that hide
    bool NotFinite = false;               ///< whether NaN and infinite samples are hidden
    vtkBlockMask Mask;                    ///< of the blocks encoded so far

    bool MayHide() const { return this->Flags || this->NotFinite; }
  };

  /**
   * Encode layers [first, last) from one component of an array that holds their tuples, the first
   * being that of layer `first`. Layers must be encoded in order, each once. As soon as a value
   * that is not finite (as float32) has been seen, here or in `summary`, values are counted but no
   * longer encoded. False when stopped.
   *
   * Where all values of a block are smaller than TinyMagnitude(), zfp's encoder overflows (it
   * scales by 2^(30-exponent) in float32) and yields arbitrary values of about that size. Such
   * blocks are encoded as zero, and counted.
   */
  bool Encode(vtkDataArray* array, int component, vtkTypeInt64 first, vtkTypeInt64 last,
    Hidden& hidden, Summary& summary, const Report& report);
  vtkTypeInt64 GetNumberOfLayers() const { return this->Blocks[2]; }

  static float TinyMagnitude() { return 3.1554436e-30f; } // 2^-98

  /**
   * Decode all into an array of dims[0]*dims[1]*dims[2] floats. False when stopped.
   */
  bool Decode(float* samples, const Report& report);

  /**
   * Decode the blocks [first, last) along each axis, in the calling thread, into a box of
   * 4*(last-first) samples per axis, x fastest. Samples beyond the volume's upper borders are zfp's
   * padding. Threads may share this object.
   */
  void DecodeBox(const int first[3], const int last[3], float* samples) const;

  /**
   * Decode all only to summarise the samples. False when stopped.
   */
  bool Summarise(Summary& summary, const Report& report);

private:
  // A block's place among the blocks, the index of its lowest sample, and its number of samples per
  // axis, fewer than 4 at the upper borders.
  struct Block
  {
    vtkTypeInt64 Position[3];
    vtkTypeInt64 Sample;
    int Size[3];
    bool IsWhole() const { return this->Size[0] + this->Size[1] + this->Size[2] == 12; }
  };
  struct Codec;
  template <typename ArrayT>
  struct Encoder;
  struct EncodeWorker;

  Block GetBlock(vtkTypeInt64 index) const;
  void GoToNext(Block& block) const;
  void FindSamples(Block& block) const;
  template <typename Body>
  bool ForEachBlock(vtkTypeInt64 first, vtkTypeInt64 last, bool write, Summary& summary,
    const Report& report, Body body);

  vtkTypeInt64 Dimensions[3];
  vtkTypeInt64 Blocks[3];
  int BlockBits;
  void* Words;
  int Threads;
};

#endif
