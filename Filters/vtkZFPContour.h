// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPContour
 * @brief   isosurfaces of a compressed volume as triangles, decoded a brick at a time
 *
 * Makes of a compressed volume (see vtkCompressedVolume) the vtkPolyData that vtkFlyingEdges3D
 * makes of the decoded image: the same points, to the last bit of their coordinates, normals and
 * gradients, and the same triangles, in another order. The order does not depend on the number of
 * threads. Of an image whose axes are left-handed, vtkFlyingEdges3D's surface is inside out, and
 * this filter's is not, see TurnOutward().
 *
 * The volume is never decoded as a whole. It is cut into bricks of BrickSize^3 cells. Every thread
 * decodes one at a time and contours it with vtkFlyingEdges3D, and the parts are joined at the
 * points that they share. With bricks of the default size, a thread needs 2 MiB of memory, beside
 * the mesh and, until they are joined, its parts, which take about two thirds as much.
 *
 * A compressed volume has no ranges of bricks: the first update decodes every brick, and remembers
 * its range (8 bytes a brick). While the input stays the same, later updates, such as with other
 * isovalues, decode only the bricks that contain an isovalue.
 *
 * Other arrays of the input, of points, or of cells if the compressed one is, are interpolated at
 * the surface's points.
 *
 * The samples of cell data lie in the centres of cells. The input's field data, without the
 * compressed stream, are passed on. Points are float32, as those of vtkFlyingEdges3D. There is no
 * array to choose, because a compressed volume has only one.
 *
 * Of a subset of a volume, whose stream covers samples around it, the output has the subset's
 * triangles. Where several processes have pieces of a volume, each has the triangles of its own,
 * and as many ghost levels around, marked as ghost cells (vtkGhostType), as are requested. Normals
 * and gradients also use the samples beyond.
 *
 * vtkSMPTools contours bricks in parallel. The thread that updates the filter reports progress, and
 * notices an abort, after which the output is empty.
 *
 * Errors, each one message and an empty output: an input that is not a compressed volume (compress
 * it first, or use vtkFlyingEdges3D), or whose metadata or stream is inconsistent (see
 * vtkCompressedVolume::Read); an isovalue that is not finite.
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
class vtkPolyData;

class VTKPROGISOFILTERS_EXPORT vtkZFPContour : public vtkPolyDataAlgorithm
{
public:
  static vtkZFPContour* New();
  vtkTypeMacro(vtkZFPContour, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Includes that of the isovalues.
   */
  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * The isovalues, in the units of the samples, as in vtkContourFilter. Default: one, 0. The
   * triangles of the first come first.
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
   * Sets isovalues in equal steps; both ends of the range are among them.
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
   * Whether to compute gradients of the samples, the point array "Gradients". Off by default.
   */
  vtkSetMacro(ComputeGradients, vtkTypeBool);
  vtkGetMacro(ComputeGradients, vtkTypeBool);
  vtkBooleanMacro(ComputeGradients, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether to store the isovalue at every point, in an array with the compressed array's name. On
   * by default.
   */
  vtkSetMacro(ComputeScalars, vtkTypeBool);
  vtkGetMacro(ComputeScalars, vtkTypeBool);
  vtkBooleanMacro(ComputeScalars, vtkTypeBool);
  ///@}

  /**
   * Turns what vtkFlyingEdges3D makes of an image as all surfaces should be: normals point to
   * smaller values, and corners go around them counterclockwise. VTK's do not where the image's
   * direction matrix mirrors, as that of most brain scans; nothing changes where it does not.
   */
  static void TurnOutward(vtkImageData* image, vtkPolyData* surface);

  ///@{
  /**
   * Level of detail whose surface is made; 0, the default, is the volume itself. A level that the
   * volume does not have is an error. The surface of a level covers all of the stream, also the
   * ghost samples of a piece of an image, and has no other arrays interpolated.
   */
  vtkSetClampMacro(Level, int, 0, 11);
  vtkGetMacro(Level, int);
  ///@}

  ///@{
  /**
   * Cells along the side of a brick, from 4 to 256, rounded down to a multiple of 4. Default 64.
   * Smaller bricks need less memory, and more of them can be skipped; larger ones overlap less, for
   * a brick is decoded with the samples around it.
   */
  void SetBrickSize(int size);
  vtkGetMacro(BrickSize, int);
  ///@}

  ///@{
  /**
   * Number of threads; 0, the default, takes all that vtkSMPTools offers. If its backend is
   * Sequential, as in VTK's wheels, STDThread is used instead; 1 starts no threads.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Statistics of the last update: bricks of the volume, those that were decoded, and the most
   * bytes of decoded samples that all threads held at a time.
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
  void ContourVolume(vtkImageData* input, vtkCompressedVolume* volume, vtkInformation* inputInfo,
    vtkInformation* outputInfo, vtkPolyData* output);
  void ContourLevel(vtkImageData* input, vtkCompressedVolume* volume, vtkPolyData* output);

  vtkNew<vtkContourValues> ContourValues;
  vtkTypeBool ComputeNormals = true;
  vtkTypeBool ComputeGradients = false;
  vtkTypeBool ComputeScalars = true;
  int Level = 0;
  int BrickSize = 64;
  int NumberOfThreads = 0;
  vtkIdType NumberOfBricks = 0;
  vtkIdType NumberOfDecodedBricks = 0;
  vtkTypeInt64 PeakSampleBytes = 0;
  std::unique_ptr<BrickRanges> Ranges; // of the last input's bricks
};

#endif
