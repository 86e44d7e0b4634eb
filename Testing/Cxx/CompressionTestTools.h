// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tools of the tests of compression: test images, libzfp as the reference, and a collector of
// errors.
#ifndef CompressionTestTools_h
#define CompressionTestTools_h

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCompressedVolume.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageZFPCompress.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <zfp.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <random>
#include <string>
#include <vector>

namespace test
{
using Dims = std::array<int, 3>;

inline vtkIdType Product(const Dims& dims)
{
  return static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2];
}

// Makes smooth values with noise, always the same.
inline std::vector<float> Samples(const Dims& dims, unsigned int seed = 1)
{
  std::mt19937 generator(seed);
  std::vector<float> values(Product(dims));
  float last = 0.0f;
  for (float& value : values)
  {
    // not by a distribution, which differs between libraries
    last = 0.9f * last + static_cast<float>(generator() % 2001) - 1000.0f;
    value = 0.125f * last;
  }
  return values;
}

// Makes an image with one array, and no part of its geometry at its default.
inline vtkSmartPointer<vtkImageData> Image(
  const Dims& dims, vtkDataArray* array, bool cells = false, const char* name = "density")
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  const int more = cells ? 0 : -1;
  image->SetExtent(3, 3 + dims[0] + more, -2, -2 + dims[1] + more, 5, 5 + dims[2] + more);
  image->SetSpacing(0.5, 2.0, 3.0);
  image->SetOrigin(1.0, -2.0, 3.0);
  const double direction[9] = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };
  image->SetDirectionMatrix(direction);
  if (name)
  {
    array->SetName(name);
  }
  if (cells)
  {
    image->GetCellData()->SetScalars(array);
  }
  else
  {
    image->GetPointData()->SetScalars(array);
  }
  return image;
}

inline vtkSmartPointer<vtkFloatArray> FloatArray(const std::vector<float>& values)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

inline vtkSmartPointer<vtkImageData> FloatImage(const Dims& dims, bool cells = false)
{
  return Image(dims, FloatArray(Samples(dims)), cells);
}

// The results of libzfp itself.
struct Reference
{
  std::vector<vtkTypeUInt64> Stream;
  std::vector<float> Decoded;
  double Rate = 0.0;

  Reference(const Dims& dims, std::vector<float> values, double rate)
    : Decoded(values.size())
  {
    zfp_field* field = zfp_field_3d(values.data(), zfp_type_float, dims[0], dims[1], dims[2]);
    zfp_stream* zfp = zfp_stream_open(nullptr);
    this->Rate = zfp_stream_set_rate(zfp, rate, zfp_type_float, 3, zfp_false);
    this->Stream.resize(zfp_stream_maximum_size(zfp, field) / 8 + 1);
    bitstream* bits = stream_open(this->Stream.data(), 8 * this->Stream.size());
    zfp_stream_set_bit_stream(zfp, bits);
    zfp_stream_rewind(zfp);
    this->Stream.resize(zfp_compress(zfp, field) / 8);
    zfp_stream_rewind(zfp);
    zfp_field_set_pointer(field, this->Decoded.data());
    zfp_decompress(zfp, field);
    stream_close(bits);
    zfp_stream_close(zfp);
    zfp_field_free(field);
  }

  bool Equals(vtkUnsignedCharArray* stream) const
  {
    return stream &&
      stream->GetNumberOfValues() == static_cast<vtkIdType>(8 * this->Stream.size()) &&
      memcmp(stream->GetPointer(0), this->Stream.data(), 8 * this->Stream.size()) == 0;
  }
};

// Collects the errors of an algorithm and its executive.
class Errors
{
public:
  explicit Errors(vtkAlgorithm* algorithm)
  {
    this->Observer->SetClientData(this);
    this->Observer->SetCallback([](vtkObject*, unsigned long, void* self, void* text)
      { static_cast<Errors*>(self)->Texts.emplace_back(static_cast<const char*>(text)); });
    algorithm->AddObserver("ErrorEvent", this->Observer);
    algorithm->GetExecutive()->AddObserver("ErrorEvent", this->Observer);
  }

  // Whether there was exactly one error, with these words.
  bool IsOne(const std::string& words) const
  {
    return this->Texts.size() == 1 && this->Texts[0].find(words) != std::string::npos;
  }

  std::string Describe() const
  {
    std::string all = std::to_string(this->Texts.size()) + " error(s)";
    for (const std::string& text : this->Texts)
    {
      all += "\n  " + text;
    }
    return all;
  }

  std::vector<std::string> Texts;

private:
  vtkNew<vtkCallbackCommand> Observer;
};

inline vtkSmartPointer<vtkImageData> Compress(vtkImageData* image, double rate = 8.0)
{
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(image);
  compress->SetRate(rate);
  compress->Update();
  return compress->GetOutput();
}

inline bool SameGeometry(vtkImageData* a, vtkImageData* b)
{
  bool same = std::equal(a->GetExtent(), a->GetExtent() + 6, b->GetExtent());
  for (int i = 0; i < 9; ++i)
  {
    same = same && a->GetDirectionMatrix()->GetData()[i] == b->GetDirectionMatrix()->GetData()[i] &&
      a->GetSpacing()[i % 3] == b->GetSpacing()[i % 3] &&
      a->GetOrigin()[i % 3] == b->GetOrigin()[i % 3];
  }
  return same;
}
}

#endif
