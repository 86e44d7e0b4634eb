// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockTrial.h"

#include <cstring>

namespace
{
//------------------------------------------------------------------------------
// Whether all bits of a block's samples agree, signs of zero included.
bool AreAllAlike(const float samples[BlockSamples])
{
  return std::memcmp(samples, samples + 1, (BlockSamples - 1) * sizeof(float)) == 0;
}
}

//------------------------------------------------------------------------------
BlockTrial::BlockTrial()
  : Bits(stream_open(this->Words, sizeof(this->Words)))
  , Stream(zfp_stream_open(this->Bits))
{
}

//------------------------------------------------------------------------------
BlockTrial::~BlockTrial()
{
  zfp_stream_close(this->Stream);
  stream_close(this->Bits);
}

//------------------------------------------------------------------------------
BlockTrial& BlockTrial::OfThread()
{
  thread_local BlockTrial trial;
  return trial;
}

//------------------------------------------------------------------------------
void BlockTrial::Run(const float samples[BlockSamples], const int size[3], int blockBits)
{
  const bool isWhole = size[0] + size[1] + size[2] == 3 * BlockSide;
  const bool isUniform = isWhole && AreAllAlike(samples);
  if (isUniform && this->IsUniform && this->BlockBits == blockBits &&
    std::memcmp(&this->Value, samples, sizeof(float)) == 0)
  {
    return;
  }
  zfp_stream_set_params(this->Stream, blockBits, blockBits, ZFP_MAX_PREC, ZFP_MIN_EXP);
  stream_rewind(this->Bits);
  if (isWhole)
  {
    zfp_encode_block_float_3(this->Stream, samples);
  }
  else
  {
    zfp_encode_partial_block_strided_float_3(
      this->Stream, samples, size[0], size[1], size[2], 1, BlockSide, BlockSlice);
  }
  stream_flush(this->Bits);
  stream_rewind(this->Bits);
  zfp_decode_block_float_3(this->Stream, this->Decoded);
  this->BlockBits = blockBits;
  this->IsUniform = isUniform;
  this->Value = samples[0];
}

//------------------------------------------------------------------------------
void BlockTrial::CopyTo(zfp_stream* stream)
{
  stream_rewind(this->Bits);
  stream_copy(zfp_stream_bit_stream(stream), this->Bits, this->BlockBits);
}
