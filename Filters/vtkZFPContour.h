// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPContour
 * @brief   isosurfaces of a compressed volume as triangles, decoding a brick at a time
 *
 * Takes a compressed volume (see vtkCompressedVolume) and produces a vtkPolyData: the surface that
 * vtkFlyingEdges3D makes of the decoded image, with the same points, to the last bit of their
 * coordinates, normals and gradients, and the same triangles, though in another order. The order
 * does not depend on the number of threads.
 *
 * The volume is never decoded as a whole. It is cut into bricks of BrickSize^3 cells; every thread
 * decodes one at a time and contours it with vtkFlyingEdges3D, and the parts are joined at the
 * points that they share. For bricks of the default size, that takes 2 MiB of memory a thread,
 * beside the surface and, until they are joined, its parts, which take about two thirds as much.
 *
 * A compressed volume does not say between which values a brick's samples lie: the first update
 * decodes every brick once, and remembers their ranges (8 bytes a brick). As long as the input
 * stays the same, later updates, with other isovalues for example, decode those bricks only that
 * hold an isovalue.
 *
 * Of cell data the samples lie in the cells' centres. What the input's field data hold beside the
 * compressed stream is passed on. Points are float32, as vtkFlyingEdges3D's are. There is no
 * array to choose: a compressed volume holds one.
 *
 * Of a piece of a volume, whose stream covers samples around it, the triangles beyond the piece are
 * there too, marked as ghost cells (vtkGhostType): they are those of other pieces.
 *
 * Bricks are contoured in parallel by vtkSMPTools. Progress events are sent, and an abort is
 * noticed (the output is then empty), by the thread that updates the filter.
 *
 * Errors, each one message and an empty output: an input that is not a compressed volume, which is
 * to be compressed first or contoured by vtkFlyingEdges3D itself, or whose metadata or stream is
 * inconsistent (see vtkCompressedVolume::Read); an isovalue that is not finite.
 *
 * @sa vtkImageZFPCompress vtkCompressedVolume vtkFlyingEdges3D vtkProgressiveIsosurfaceMapper
 */
#ifndef vtkZFPContour_h
#define vtkZFPContour_h

#include "vtkContourValues.h" // passes calls through
#include "vtkNew.h"           // for the isovalues
#include "vtkPolyDataAlgorithm.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

#include <memory> // for ranges
#include <vector> // for isovalues

class BrickRanges;
class vtkCompressedVolume;
class vtkImageData;

class VTKPROGISOFILTERS_EXPORT vtkZFPContour : public vtkPolyDataAlgorithm
{
public:
  static vtkZFPContour* New();
  vtkTypeMacro(vtkZFPContour, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Isovalues count.
   */
  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * The isovalues, in the units of the samples, as in vtkContourFilter and its like. One, 0, by
   * default. The triangles of the first come first.
   */
  void SetValue(int i, double value) { this->ContourValues->SetValue(i, value); }
  double GetValue(int i) { return this->ContourValues->GetValue(i); }
  double* GetValues() { return this->ContourValues->GetValues(); }
  void GetValues(double* values) { this->ContourValues->GetValues(values); }
  void SetNumberOfContours(int number) { this->ContourValues->SetNumberOfContours(number); }
  vtkIdType GetNumberOfContours() { return this->ContourValues->GetNumberOfContours(); }
  ///@}

  ///@{
  /**
   * Isovalues in equal steps; the ends of the range are among them.
   */
  void GenerateValues(int number, double range[2])
  {
    this->ContourValues->GenerateValues(number, range);
  }
  void GenerateValues(int number, double first, double last)
  {
    this->ContourValues->GenerateValues(number, first, last);
  }
  ///@}

  ///@{
  /**
   * Whether to compute unit normals, the point array "Normals". On by default.
   */
  vtkSetMacro(ComputeNormals, vtkTypeBool);
  vtkGetMacro(ComputeNormals, vtkTypeBool);
  vtkBooleanMacro(ComputeNormals, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether to keep the samples' gradients, the point array "Gradients". Off by default.
   */
  vtkSetMacro(ComputeGradients, vtkTypeBool);
  vtkGetMacro(ComputeGradients, vtkTypeBool);
  vtkBooleanMacro(ComputeGradients, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether to store the isovalue at every point, in an array that has the compressed array's name.
   * On by default.
   */
  vtkSetMacro(ComputeScalars, vtkTypeBool);
  vtkGetMacro(ComputeScalars, vtkTypeBool);
  vtkBooleanMacro(ComputeScalars, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Cells along the side of a brick, from 4 to 256, default 64. Rounded down to a multiple of 4.
   * Smaller ones take less memory and are passed over more often, larger ones overlap less: a brick
   * is decoded with the samples around it.
   */
  void SetBrickSize(int size);
  vtkGetMacro(BrickSize, int);
  ///@}

  ///@{
  /**
   * Threads used; 0, the default, takes all that vtkSMPTools offers. Where its backend is
   * Sequential, as in VTK's wheels, STDThread is used instead; set 1 to have no threads.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Of the last update: bricks of the volume, those that were decoded, and the most bytes of
   * decoded samples that all threads held at a time.
   */
  vtkGetMacro(NumberOfBricks, vtkIdType);
  vtkGetMacro(NumberOfDecodedBricks, vtkIdType);
  vtkGetMacro(PeakSampleBytes, vtkTypeInt64);
  ///@}

protected:
  vtkZFPContour();
  ~vtkZFPContour() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkZFPContour(const vtkZFPContour&) = delete;
  void operator=(const vtkZFPContour&) = delete;

  std::vector<double> GetIsovalues();
  void ContourVolume(vtkImageData* input, vtkCompressedVolume* volume, vtkPolyData* output);

  vtkNew<vtkContourValues> ContourValues;
  vtkTypeBool ComputeNormals = true;
  vtkTypeBool ComputeGradients = false;
  vtkTypeBool ComputeScalars = true;
  int BrickSize = 64;
  int NumberOfThreads = 0;
  vtkIdType NumberOfBricks = 0;
  vtkIdType NumberOfDecodedBricks = 0;
  vtkTypeInt64 PeakSampleBytes = 0;
  std::unique_ptr<BrickRanges> Ranges; // of the last input's bricks
};

#endif
