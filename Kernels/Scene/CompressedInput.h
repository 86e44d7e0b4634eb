// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// An image as the pipeline takes it: a compressed volume, or an array of a plain image, which is
// compressed here and kept until something that it was made from changes.
#ifndef CompressedInput_h
#define CompressedInput_h

#include "Pipeline/ProgressivePipeline.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTimeStamp.h"

#include <string>
#include <tuple>

class vtkCompressedVolume;
class vtkDataArray;
class vtkImageData;

class CompressedInput
{
public:
  /// What of an image is taken, and how it is compressed where it is plain.
  struct Choice
  {
    vtkImageData* Image = nullptr;
    vtkDataArray* Array = nullptr; ///< null: the image is a compressed volume
    bool CellData = false;         ///< the array is of cells
    int Component = 0;
    double Rate = 8.0;
    bool MaskNonFinite = false;
  };

  CompressedInput();
  ~CompressedInput();
  CompressedInput(const CompressedInput&) = delete;
  void operator=(const CompressedInput&) = delete;

  /// Make sure that this is of the image as it is now. False where it cannot be: GetError() tells
  /// why, unless the filter that compresses has told already.
  bool Take(const Choice& choice);
  /// Be of no image.
  void Release();

  const std::string& GetError() const { return this->Error; }
  /// The compressed image; null where there is none.
  vtkImageData* GetImage() const { return this->Image; }
  vtkCompressedVolume* GetVolume() const { return this->Volume; }
  /// When it became another volume, or none.
  vtkMTimeType GetTime() const { return this->Time; }

private:
  /// Image, array and their times, and what else makes a plain image another volume.
  using Key =
    std::tuple<vtkImageData*, vtkMTimeType, vtkDataArray*, vtkMTimeType, double, int, bool>;

  vtkSmartPointer<vtkImageData> Image;
  vtkNew<vtkCompressedVolume> Volume;
  Key Source;
  vtkTimeStamp Time;
  std::string Error;
};

///@{ What the pipeline uploads of a compressed volume; it shares the ownership of the stream.
CompressedStream DescribeStream(vtkCompressedVolume* volume);
PipelineVolume DescribeVolume(vtkCompressedVolume* volume);
///@}

#endif
