// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares our codec with Debian's libzfp, which has its own bit stream: streams of any bits decode
// to the same samples, any samples encode to the same bits, and our bit stream
// (cmake/zfp/bitstream.inl) does the same call by call.
#include "FuzzTools.h"

#include <vtkCompressedVolumeBuilder.h>
#include <vtkImageZFPDecompress.h>

#include <dlfcn.h>

namespace
{
using namespace fuzz;

//------------------------------------------------------------------------------
// The functions of libzfp.so.1, which have the same names as ours.
struct LibZFP
{
  void* Handle = dlopen("libzfp.so.1", RTLD_NOW | RTLD_LOCAL);

  template <typename F>
  F* Get(F*, const char* name) const
  {
    CHECK(this->Handle, dlerror());
    auto* const function = reinterpret_cast<F*>(dlsym(this->Handle, name));
    CHECK(function, name);
    return function;
  }
};
const LibZFP Library;

#define LIBZFP(name) static auto* const lib_##name = Library.Get(&name, #name)

//------------------------------------------------------------------------------
struct ReferenceCodec
{
  ReferenceCodec(const int dims[3], int blockBits, void* words, std::size_t size, float* samples)
  {
    LIBZFP(stream_open);
    LIBZFP(zfp_stream_open);
    LIBZFP(zfp_stream_set_params);
    LIBZFP(zfp_field_3d);
    this->Bits = lib_stream_open(words, size);
    this->Stream = lib_zfp_stream_open(this->Bits);
    lib_zfp_stream_set_params(this->Stream, blockBits, blockBits, ZFP_MAX_PREC, ZFP_MIN_EXP);
    this->Field = lib_zfp_field_3d(samples, zfp_type_float, dims[0], dims[1], dims[2]);
  }
  ~ReferenceCodec()
  {
    LIBZFP(stream_close);
    LIBZFP(zfp_stream_close);
    LIBZFP(zfp_field_free);
    lib_zfp_field_free(this->Field);
    lib_zfp_stream_close(this->Stream);
    lib_stream_close(this->Bits);
  }

  void Decode()
  {
    LIBZFP(zfp_decompress);
    CHECK(lib_zfp_decompress(this->Stream, this->Field) > 0, "libzfp");
  }
  void Encode()
  {
    LIBZFP(zfp_compress);
    CHECK(lib_zfp_compress(this->Stream, this->Field) > 0, "libzfp");
  }

  bitstream* Bits;
  zfp_stream* Stream;
  zfp_field* Field;
};

//------------------------------------------------------------------------------
void CheckDecoding(const int dims[3], int blockBits, Bytes& bytes)
{
  const vtkIdType samples = static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2];
  vtkNew<vtkUnsignedCharArray> stream;
  stream->SetNumberOfValues(vtkCompressedVolume::StreamBytesFor(dims, blockBits));
  bytes.Fill(stream->GetPointer(0), stream->GetNumberOfValues());
  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(blockBits);
  volume->SetDimensions(dims);
  volume->SetScalarType(VTK_FLOAT);
  volume->SetStream(stream);
  vtkNew<vtkImageData> image;
  image->SetDimensions(dims);
  volume->Write(image);
  vtkNew<vtkImageZFPDecompress> decompress;
  decompress->SetInputData(image);
  CHECK(Update(decompress), "not decompressed");
  auto* const decoded =
    vtkArrayDownCast<vtkFloatArray>(decompress->GetOutput()->GetPointData()->GetScalars());

  // one more word, because zfp reads ahead
  std::vector<vtkTypeUInt64> words(stream->GetNumberOfValues() / 8 + 1);
  std::memcpy(words.data(), stream->GetPointer(0), stream->GetNumberOfValues());
  std::vector<float> expected(samples);
  ReferenceCodec reference(dims, blockBits, words.data(), 8 * words.size(), expected.data());
  reference.Decode();
  CHECK(std::memcmp(expected.data(), decoded->GetPointer(0), 4 * samples) == 0,
    "decoded differently at " << blockBits << " bits");
}

//------------------------------------------------------------------------------
// Makes finite samples; tiny ones are zero, as SampleEncoder encodes them.
std::vector<float> MakeSamples(const int dims[3], Bytes& bytes)
{
  std::vector<float> samples(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]);
  bytes.Fill(reinterpret_cast<unsigned char*>(samples.data()), 4 * samples.size());
  for (float& sample : samples)
  {
    const float magnitude = std::abs(sample);
    sample = magnitude >= 1e-29f && magnitude <= std::numeric_limits<float>::max() ? sample : 0.0f;
  }
  return samples;
}

//------------------------------------------------------------------------------
void CheckEncoding(const int dims[3], int blockBits, Bytes& bytes)
{
  std::vector<float> samples = MakeSamples(dims, bytes);
  vtkNew<vtkCompressedVolumeBuilder> builder;
  vtkNew<vtkImageData> image;
  CHECK(builder->Start(dims, blockBits / 64.0), builder->GetErrorMessage());
  CHECK(builder->AddSlab(test::FloatArray(samples)), builder->GetErrorMessage());
  CHECK(builder->Finish(image), builder->GetErrorMessage());
  vtkNew<vtkCompressedVolume> volume;
  CHECK(volume->Read(image), volume->GetErrorMessage());
  const std::size_t size = volume->GetStream()->GetNumberOfValues();
  std::vector<vtkTypeUInt64> words(size / 8 + 64);
  ReferenceCodec reference(dims, blockBits, words.data(), 8 * words.size(), samples.data());
  reference.Encode();
  CHECK(std::memcmp(words.data(), volume->GetStream()->GetPointer(0), size) == 0,
    "encoded differently at " << blockBits << " bits");
}

//------------------------------------------------------------------------------
// Calls the same functions of our bit stream and of libzfp's, at positions within their words.
class BitStreams
{
public:
  BitStreams(Bytes& bytes)
  {
    LIBZFP(stream_open);
    bytes.Fill(reinterpret_cast<unsigned char*>(this->Words[0]), sizeof(this->Words[0]));
    std::copy_n(this->Words[0], Count, this->Words[1]);
    this->Ours = stream_open(this->Words[0], sizeof(this->Words[0]));
    this->Theirs = lib_stream_open(this->Words[1], sizeof(this->Words[1]));
  }
  ~BitStreams()
  {
    LIBZFP(stream_close);
    stream_close(this->Ours);
    lib_stream_close(this->Theirs);
  }

#define BOTH(name, ...)                                                                            \
  LIBZFP(name);                                                                                    \
  const vtkTypeUInt64 ours = name(this->Ours, ##__VA_ARGS__);                                      \
  const vtkTypeUInt64 theirs = lib_##name(this->Theirs, ##__VA_ARGS__);                            \
  CHECK(ours == theirs, #name << ": " << ours << ", not " << theirs)
#define BOTH_DO(name, ...)                                                                         \
  LIBZFP(name);                                                                                    \
  name(this->Ours, ##__VA_ARGS__);                                                                 \
  lib_##name(this->Theirs, ##__VA_ARGS__)

  void Read(Bytes& bytes)
  {
    const bitstream_count n = bytes.Below(65);
    switch (bytes.Below(6))
    {
      case 0:
      {
        BOTH(stream_read_bit);
        break;
      }
      case 1:
      case 2:
      {
        BOTH(stream_read_bits, n);
        break;
      }
      case 3:
      {
        BOTH_DO(stream_skip, n);
        break;
      }
      case 4:
      {
        LIBZFP(stream_skip);
        lib_stream_skip(this->Theirs, stream_align(this->Ours));
        break;
      }
      default:
      {
        const bitstream_offset offset = bytes.Below(64 * Half);
        BOTH_DO(stream_rseek, offset);
      }
    }
    BOTH(stream_rtell);
  }

  void Write(Bytes& bytes)
  {
    const bitstream_count n = bytes.Below(65);
    switch (bytes.Below(6))
    {
      case 0:
      {
        BOTH(stream_write_bit, static_cast<uint>(n % 2));
        break;
      }
      case 1:
      case 2:
      {
        const vtkTypeUInt64 value = bytes.Take<vtkTypeUInt64>();
        BOTH(stream_write_bits, value, n);
        break;
      }
      case 3:
      {
        BOTH_DO(stream_pad, 3 * n);
        break;
      }
      case 4:
      {
        this->Flush();
        break;
      }
      default:
      {
        this->Flush();
        const bitstream_offset offset = bytes.Below(64 * Half);
        BOTH_DO(stream_wseek, offset);
      }
    }
    BOTH(stream_wtell);
  }

  // libzfp may have shorter words than ours, and so may the padding that its functions add.
  void Flush()
  {
    LIBZFP(stream_pad);
    LIBZFP(stream_flush);
    lib_stream_pad(this->Theirs, stream_flush(this->Ours));
    CHECK(lib_stream_flush(this->Theirs) == 0, "not at the end of a word");
  }

  void Check() const
  {
    CHECK(
      std::equal(this->Words[0], this->Words[0] + Count, this->Words[1]), "written differently");
  }

  // few enough calls between two checks to stay within the words
  static constexpr int Operations = 32;

private:
  static constexpr int Half = 128;
  static constexpr int Count = 2 * Half;
  vtkTypeUInt64 Words[2][Count];
  bitstream* Ours;
  bitstream* Theirs;
};

//------------------------------------------------------------------------------
void CheckBitStream(Bytes& bytes)
{
  const bool write = bytes.Flag();
  BitStreams streams(bytes);
  for (int i = 0; i < BitStreams::Operations && bytes.Left() > 0; ++i)
  {
    write ? streams.Write(bytes) : streams.Read(bytes);
  }
  if (write)
  {
    streams.Flush();
  }
  streams.Check();
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  const int kind = bytes.Below(3);
  if (kind == 2)
  {
    CheckBitStream(bytes);
    return 0;
  }
  int dims[3];
  std::generate_n(dims, 3, [&]() { return 2 + bytes.Below(12); });
  const int blockBits = 9 + bytes.Below(2040);
  kind == 0 ? CheckDecoding(dims, blockBits, bytes) : CheckEncoding(dims, blockBits, bytes);
  return 0;
}
