// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// An image in the form that the pipeline takes: a compressed volume. An array of a plain image is
// compressed, and kept until the image, the array or the choice changes.
#ifndef CompressedInput_h
#define CompressedInput_h

#include "Pipeline/ProgressivePipeline.h"
#include "Status.h"

#include "vtkBlockMask.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTimeStamp.h"

#include <cstdint>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

class vtkCompressedVolume;
class vtkDataArray;
class vtkImageData;

class CompressedInput
{
public:
  /// Which array of an image, and how a plain one is compressed.
  struct Choice
  {
    vtkImageData* Image = nullptr;
    vtkDataArray* Array = nullptr; ///< null: the image is a compressed volume
    bool CellData = false;         ///< the array is of cells
    int Component = 0;
    double Rate = 8.0;
    bool MaskNonFinite = true;
    bool KeepLabels = false;
    int Levels = 0; ///< of detail that a plain one gets
  };

  CompressedInput();
  ~CompressedInput();
  CompressedInput(const CompressedInput&) = delete;
  void operator=(const CompressedInput&) = delete;

  /// Updates the compressed volume if the image or the choice has changed. What failed is not tried
  /// again before: the same error comes back.
  Status Update(const Choice& choice);
  /// Drops the image.
  void Release();

  /// Calls a function with the fraction that is compressed, while an array is.
  void SetProgress(std::function<void(double)> progress) { this->Progress = std::move(progress); }

  /// The compressed image, or null.
  vtkImageData* GetImage() const;
  vtkCompressedVolume* GetVolume() const { return this->Volume; }
  /// Bytes of host memory that a plain image's compressed form takes beside the input; 0 of others.
  std::int64_t GetHostBytes() const;
  /// When the image last changed, or an attempt failed.
  vtkMTimeType GetTime() const { return this->Time; }

private:
  Status Read(const Choice& choice);

  /// Image and array with their times, rate, component, mask, labels and levels: a change of any of
  /// them changes the volume.
  using Key = std::tuple<vtkImageData*, vtkMTimeType, vtkDataArray*, vtkMTimeType, double, int,
    bool, bool, int>;

  vtkSmartPointer<vtkImageData> Image;
  vtkNew<vtkCompressedVolume> Volume;
  Key Source;    ///< of the last attempt
  Status Result; ///< likewise
  std::function<void(double)> Progress;
  vtkTimeStamp Time;
};

/// What a level of detail hides, and the number of its blocks.
struct HiddenInLevel
{
  vtkBlockMask Mask;
  std::int64_t Blocks;
};

///@{ What the pipeline uploads of a compressed volume. It shares the ownership of the stream.
CompressedStream DescribeStream(vtkCompressedVolume* volume);
/// `levels`: how many coarser levels of detail, which have ranges.
PipelineVolume DescribeVolume(vtkCompressedVolume* volume, int levels = 0);
/// What the samples of the volume, and of so many coarser levels, hide.
std::vector<std::uint32_t> DescribeHiddenSamples(vtkCompressedVolume* volume, int levels);
/// The volume itself, which is level 0, or a coarser one.
vtkCompressedVolume* LevelOf(vtkCompressedVolume* volume, int level);
/// Packs the runs of masks of levels of detail, the volume's first, as Buffers.glsl reads them:
/// blocks are numbered through all levels. Empty if none hides anything.
std::vector<std::uint32_t> DescribeHidden(const std::vector<HiddenInLevel>& levels);
///@}

#endif
