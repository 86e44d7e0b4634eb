// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ZFPHeader.h"

#include "vtkCompressedVolume.h"

#include <zfp.h>

static_assert(ZFPHeader::MaximumWords == (ZFP_HEADER_MAX_BITS + 63) / 64, "room for any header");

namespace
{
//------------------------------------------------------------------------------
const char* ModeName(zfp_mode mode)
{
  switch (mode)
  {
    case zfp_mode_fixed_precision:
      return "fixed precision";
    case zfp_mode_fixed_accuracy:
      return "fixed accuracy";
    case zfp_mode_reversible:
      return "reversible";
    default:
      return "expert";
  }
}

//------------------------------------------------------------------------------
// What zfp finds in a header; a length of 0 if that is none.
struct ParsedHeader
{
  int Bits;
  zfp_field Field;
  zfp_mode Mode;
  unsigned int BlockBits;
};

ParsedHeader Parse(vtkTypeUInt64 words[ZFPHeader::MaximumWords])
{
  bitstream* bits = stream_open(words, ZFPHeader::MaximumWords * sizeof(vtkTypeUInt64));
  zfp_stream* zfp = zfp_stream_open(bits);
  zfp_field* field = zfp_field_alloc();
  ParsedHeader parsed;
  parsed.Bits = static_cast<int>(zfp_read_header(zfp, field, ZFP_HEADER_FULL));
  parsed.Field = *field;
  parsed.Mode = zfp_stream_compression_mode(zfp);
  parsed.BlockBits = zfp->maxbits;
  zfp_field_free(field);
  zfp_stream_close(zfp);
  stream_close(bits);
  return parsed;
}

//------------------------------------------------------------------------------
Status CheckHeader(const ParsedHeader& parsed, vtkTypeInt64 fileBytes)
{
  if (parsed.Bits == 0 || parsed.Bits > 8 * fileBytes)
  {
    return Status::Error("does not start with zfp's header (codec ", zfp_codec_version,
      "); for a file without header give DataDimensions and Rate");
  }
  const unsigned int dimensionality = zfp_field_dimensionality(&parsed.Field);
  if (parsed.Field.type != zfp_type_float || dimensionality != 3)
  {
    const char* const types[] = { "none", "int32", "int64", "float", "double" };
    return Status::Error("holds a ", dimensionality, "-D ", types[parsed.Field.type],
      " array, only 3-D float can be read");
  }
  if (parsed.Mode != zfp_mode_fixed_rate)
  {
    return Status::Error("is compressed in ", ModeName(parsed.Mode),
      " mode, only fixed rate can be read: compress it with 'zfp -r RATE'");
  }
  if (parsed.BlockBits < vtkCompressedVolume::MinimumBlockBits ||
    parsed.BlockBits > vtkCompressedVolume::MaximumBlockBits)
  {
    return Status::Error(
      "has a rate of ", parsed.BlockBits / 64.0, " bits per sample, not in 9/64..32");
  }
  return {};
}
}

//------------------------------------------------------------------------------
Status ZFPHeader::Read(std::istream& file, vtkTypeInt64 fileBytes, ZFPHeader& header)
{
  vtkTypeUInt64 words[MaximumWords] = {}; // zero where the file is shorter
  file.read(reinterpret_cast<char*>(words), sizeof(words));
  const ParsedHeader parsed = Parse(words);
  if (Status status = CheckHeader(parsed, fileBytes); !status)
  {
    return status;
  }
  header.Dimensions[0] = static_cast<int>(parsed.Field.nx);
  header.Dimensions[1] = static_cast<int>(parsed.Field.ny);
  header.Dimensions[2] = static_cast<int>(parsed.Field.nz);
  header.BlockBits = static_cast<int>(parsed.BlockBits);
  header.Bits = parsed.Bits;
  return {};
}

//------------------------------------------------------------------------------
int MakeZFPHeader(const int dims[3], int blockBits, vtkTypeUInt64 words[ZFPHeader::MaximumWords])
{
  bitstream* stream = stream_open(words, ZFPHeader::MaximumWords * sizeof(vtkTypeUInt64));
  zfp_stream* zfp = zfp_stream_open(stream);
  zfp_field* field = zfp_field_3d(nullptr, zfp_type_float, dims[0], dims[1], dims[2]);
  zfp_stream_set_params(zfp, blockBits, blockBits, ZFP_MAX_PREC, ZFP_MIN_EXP);
  const std::size_t bits = zfp_write_header(zfp, field, ZFP_HEADER_FULL);
  stream_flush(stream);
  zfp_field_free(field);
  zfp_stream_close(zfp);
  stream_close(stream);
  return static_cast<int>(bits);
}
