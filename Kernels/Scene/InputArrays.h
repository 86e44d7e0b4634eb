// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The volume that is rendered, and the one that gives the surface its colours: which arrays of the
// mapper's inputs they are, and their compressed form.
#ifndef InputArrays_h
#define InputArrays_h

#include "Scene/CompressedInput.h"

#include <string>

class vtkDataArray;
class vtkImageData;

/// The mapper's properties that choose arrays of plain images and compress them.
struct ArrayChoice
{
  ///@{ Those of vtkVolumeMapper.
  int ScalarMode = 0;
  int ArrayAccessMode = 0;
  int ArrayId = -1;
  const char* ArrayName = nullptr;
  ///@}
  int Component = 0;
  const char* ColorArrayName = nullptr;
  int ColorComponent = 0;
  double Rate = 8.0;
  bool MaskNonFinite = true;
  bool KeepLabels = false;
  int Levels = 0; ///< of detail that plain ones get
};

class InputArrays
{
public:
  ///@{ Update the volumes from images, plain or compressed, if anything has changed.
  Status UpdateValues(const ArrayChoice& choice, vtkImageData* image);
  /// Takes the colours from an image of their own.
  Status UpdateColorsFromImage(const ArrayChoice& choice, vtkImageData* image);
  /// Takes the colours from the array of ColorArrayName, beside the one that is rendered.
  Status UpdateColorsFromArray(const ArrayChoice& choice, vtkImageData* image);
  ///@}
  void RemoveColors() { this->Colors.Release(); }

  /// Calls a function with the fraction that is compressed, while an array is.
  void SetProgress(const std::function<void(double)>& progress);

  const CompressedInput& GetValues() const { return this->Values; }
  /// Without an image if no other volume gives the colours.
  const CompressedInput& GetColors() const { return this->Colors; }
  /// Bytes of host memory that both take beside the inputs.
  std::int64_t GetHostBytes() const
  {
    return this->Values.GetHostBytes() + this->Colors.GetHostBytes();
  }
  /// When one of them last changed.
  vtkMTimeType GetTime() const;
  /// Counts the coarser levels of detail that can be drawn: with ranges, and of both volumes.
  int CountLevels() const;
  /// Says why there are none, as the end of a sentence; empty if there are, or need not be any.
  std::string DescribeLackOfLevels() const;
  /// Both, as the pipeline takes them, with so many coarser levels.
  PipelineVolume Describe(int levels = 0) const;

private:
  Status UpdateColors(const CompressedInput::Choice& choice);
  bool HasCellData() const;

  CompressedInput Values;
  CompressedInput Colors;
};

#endif
