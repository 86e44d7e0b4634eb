// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   PartExtractor
 * @brief   decodes and contours the bricks of a volume in parallel (internal)
 */
#ifndef PartExtractor_h
#define PartExtractor_h

#include "Codec/BlockStream.h"
#include "Contour/BrickContour.h"
#include "Contour/BrickRanges.h"
#include "Contour/SurfaceParts.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <atomic>
#include <vector>

class vtkAlgorithm;
class vtkCompressedVolume;
class vtkUnsignedCharArray;

class PartExtractor
{
public:
  /// Fraction of the progress of all work that is extraction; the rest is joining.
  static constexpr double ProgressFraction = 0.95;

  /// All arguments must outlive this object, except the volume. Isovalues are in the stream's
  /// units.
  PartExtractor(vtkCompressedVolume* volume, const Bricks& bricks, const BrickContour& contour,
    const std::vector<double>& isovalues, BrickRanges& ranges);

  /// Fills `parts`; returns false when the algorithm is aborted, to which progress is reported.
  bool Extract(vtkAlgorithm* algorithm, SurfaceParts& parts);

  vtkIdType GetNumberOfDecodedBricks() const { return this->Decoded; }

  /// The most bytes of decoded samples that all threads held at a time.
  vtkTypeInt64 GetPeakSampleBytes() const { return this->PeakSampleBytes; }

private:
  struct CountedSamples;
  std::vector<vtkIdType> FindBricks() const;
  void ExtractBrick(vtkIdType brick, CountedSamples& samples, SurfaceParts& parts);

  vtkSmartPointer<vtkUnsignedCharArray> Stream;
  BlockStream Blocks;
  const Bricks& AllBricks;
  const BrickContour& Contour;
  const std::vector<double>& Isovalues;
  BrickRanges& Ranges;
  std::atomic<vtkIdType> Decoded{ 0 };
  std::atomic<vtkTypeInt64> SampleBytes{ 0 };
  std::atomic<vtkTypeInt64> PeakSampleBytes{ 0 };
};

#endif
