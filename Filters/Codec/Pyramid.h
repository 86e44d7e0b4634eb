// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   Pyramid
 * @brief   makes and encodes the levels of detail of a volume in one pass (internal)
 *
 * Takes the volume's own samples in order of z, and keeps, beside the encoded levels, some slices
 * of each: levels are made of unencoded samples. The result depends neither on how many slices are
 * added at a time, nor on the number of threads.
 */
#ifndef Pyramid_h
#define Pyramid_h

#include "Codec/HiddenSamples.h"
#include "Codec/LevelShape.h"
#include "Codec/LevelSlice.h"
#include "Codec/Progress.h"
#include "Codec/SampleUnits.h"
#include "Status.h"

#include "vtkBlockMask.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <memory>
#include <vector>

class vtkCompressedVolume;
class vtkDataArray;

class Pyramid
{
public:
  SampleUnits Units;
  HiddenSamples Hidden;     ///< among the tuples of the next AddSlices()
  vtkBlockMask HiddenCells; ///< of the volume

  Pyramid(const int dims[3], int threads);
  ~Pyramid();

  /// Begins the levels of PlanLevels() for a volume with so many bits per block.
  Status Start(const double spacing[3], int levels, int blockBits);

  /// Takes the next slices of the volume, one component of an array. Returns false when stopped.
  bool AddSlices(vtkDataArray* array, int component, const ProgressCallback& progress);

  /// Returns the levels from 1 on, when all slices have been added. They lack what
  /// vtkCompressedVolume::AddLevel() takes from level 0.
  std::vector<vtkSmartPointer<vtkCompressedVolume>> Finish();

  /// The most slices that a level has kept of the one before from one step to the next.
  int GetMostSlicesKept() const;

private:
  class Level;

  std::vector<LevelSlice> ReadSlices(
    vtkDataArray* array, int component, vtkTypeInt64 first, int number);
  void Feed(std::vector<LevelSlice> slices);
  void HideCells(int z, LevelSlice& slice) const;

  int Dimensions[3];
  int Threads;
  int Slices = 0; // taken so far
  std::vector<std::unique_ptr<Level>> Levels;
};

#endif
