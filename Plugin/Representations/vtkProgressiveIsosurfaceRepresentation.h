// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkProgressiveIsosurfaceRepresentation
 * @brief   ParaView representation of image data as a progressive isosurface
 *
 * Shows plain image data and compressed volumes (see vtkCompressedVolume) through
 * vtkProgressiveIsosurfaceMapper. Opaque surfaces are drawn in the opaque pass, so that translucent
 * geometry blends over them, and need no ordered compositing; translucent ones are drawn with the
 * volumes. If the representation is coloured by the array that is drawn, a surface has the colour
 * map's colour at its isovalue, otherwise the solid colour.
 *
 * Of composite data sets (multi-block, partitioned, AMR) it shows all images, a mapper each, see
 * vtkIsosurfaceBlocksMapper and ImageBlocks.h. Rectilinear grids of even steps are shown as the
 * images that they are; others only if ResampleUnevenGrids is on, as no ray through their cells is
 * straight among the samples.
 *
 * If several processes share an image, each draws its own piece, and ParaView composites them. With
 * its piece a process takes the surrounding samples that normals need, in whole blocks of the whole
 * image, so that all processes decode the same values and no seam shows. It requests ghost levels
 * from the pipeline, and exchanges samples with the other processes if the pipeline has none.
 */

#ifndef vtkProgressiveIsosurfaceRepresentation_h
#define vtkProgressiveIsosurfaceRepresentation_h

#include "DrawnArray.h"
#include "SurfaceColors.h"

#include "vtkImageVolumeRepresentation.h"
#include "vtkIsosurfaceBlocksMapper.h"       // for messages
#include "vtkProgIsoRepresentationsModule.h" // for export macro

#include <string> // for ivar

class vtkDataArray;
class vtkDataSet;
class vtkImageData;
class vtkPartitionedDataSet;
class vtkPlane;
class vtkProgressiveIsosurfaceMapper;
class vtkVolumeMapper;
namespace ImageBlocks
{
struct Found;
}

class VTKPROGISOREPRESENTATIONS_EXPORT vtkProgressiveIsosurfaceRepresentation
  : public vtkImageVolumeRepresentation
{
public:
  static vtkProgressiveIsosurfaceRepresentation* New();
  vtkTypeMacro(vtkProgressiveIsosurfaceRepresentation, vtkImageVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int ProcessViewRequest(vtkInformationRequestKey* requestType, vtkInformation* inInfo,
    vtkInformation* outInfo) override;

  /**
   * The array to draw an isosurface of, in plain image data; empty: the default array, as
   * vtkImageZFPCompress chooses it. A compressed volume holds one array and ignores this. The
   * signature is that of ParaView's array selection properties.
   */
  void SetIsosurfaceArray(int index, int port, int connection, int association, const char* name);

  /// The component of that array; as many as it has: the magnitude.
  void SetIsosurfaceComponent(int component);

  ///@{
  /// The isovalues, in the units of the array; they become those of the volume property.
  void SetNumberOfIsovalues(int number);
  void SetIsovalue(int index, double value);
  ///@}

  /// Colour of the surface if no colour map applies.
  void SetDiffuseColor(double red, double green, double blue);

  /// Opacity of the surface, 0 … 1. It is multiplied by the opacity of a colour map that maps
  /// opacities.
  void SetOpacity(double opacity);

  /// Colour map, used if the representation is coloured by the isosurface array, or by another
  /// array of a plain image with the same association.
  void SetColor(vtkColorTransferFunction* colorMap);

  using Superclass::SetInputArrayToProcess;
  /// The array to colour by.
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;

  ///@{
  /**
   * Properties of the mapper: bits per voxel for plain data, whether NaN in them is hidden,
   * speculation on or off, the memory budget in mebibytes (0: automatic), the milliseconds that an
   * image may take before it is shown, or has fewer rays while the camera moves, and whether levels
   * of detail draw what is far (vtkProgressiveIsosurfaceMapper::LevelsOfDetail), with how many
   * pixels between samples.
   */
  void SetRate(double bitsPerVoxel);
  void SetMaskNonFinite(bool on);
  void SetSpeculation(bool on);
  void SetMemoryBudget(int mebibytes);
  void SetFrameTime(double milliseconds);
  void SetLevelOfDetail(int when);
  void SetPixelTolerance(double pixels);
  ///@}

  ///@{
  /**
   * Two planes, in world coordinates: the surface is drawn only on the sides to which the normals
   * of those in use point.
   */
  void SetUseClipPlane(bool on);
  void SetClipPlaneOrigin(double x, double y, double z);
  void SetClipPlaneNormal(double x, double y, double z);
  void SetUseClipPlane2(bool on);
  void SetClipPlaneOrigin2(double x, double y, double z);
  void SetClipPlaneNormal2(double x, double y, double z);
  ///@}

  /// Whether a rectilinear grid with uneven steps is resampled, see RectilinearImage.h; otherwise
  /// it is an error.
  void SetResampleUnevenGrids(bool on);

  /// The mapper that has the settings of all that draw.
  vtkProgressiveIsosurfaceMapper* GetIsosurfaceMapper();

  /// The mappers that draw the surface on this process. See vtkPVIsosurfaceInformation for the
  /// statistics of all processes.
  vtkIsosurfaceBlocksMapper* GetBlocksMapper();

  ///@{
  /// Why this process has drawn nothing, or not all (empty if it has drawn all); what it has warned
  /// of last; and how often it did so.
  vtkIsosurfaceBlocksMapper::Message GetError();
  vtkIsosurfaceBlocksMapper::Message GetWarning();
  ///@}

protected:
  vtkProgressiveIsosurfaceRepresentation();
  ~vtkProgressiveIsosurfaceRepresentation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  void UpdateMapperParameters() override;

private:
  struct ClipPlane
  {
    bool Used = false;
    vtkNew<vtkPlane> Plane;
  };

  /// Finds the array that is drawn, of an image or of blocks. Returns false if nothing can be
  /// drawn; Error says why, if it is not for other processes to draw.
  template <typename Input>
  bool FindArray(const Input& input);

  ///@{
  /// Keeps a message for the user, who may be on another machine.
  void Fail(const std::string& message);
  void Warn(const std::string& message);
  ///@}

  ///@{
  /// Makes what this process draws of its input: of an image that several processes share, its
  /// piece and the samples around it that it needs; of a composite data set its blocks.
  vtkSmartPointer<vtkImageData> MakePiece(vtkImageData* image);
  vtkSmartPointer<vtkPartitionedDataSet> MakeBlocks(vtkDataObject* input);
  ///@}
  /// Copies an image with only the array that is drawn, the one that gives the colours, and ghosts.
  vtkSmartPointer<vtkImageData> SelectArrays(vtkImageData* image);
  ///@{
  /// Takes what is drawn, and finds its outline and size.
  void SetPiece(vtkImageData* piece);
  void SetBlocks(vtkPartitionedDataSet* blocks);
  void SetDrawn(vtkDataObject* drawn, const double bounds[6]);
  ///@}

  void UpdateCropping();

  /// Tells ParaView how much of a plain image is compressed, and of what a first image takes done.
  void ShowProgress(vtkObject* caller, unsigned long event, void* fraction);

  SurfaceColors::Scene GetColorScene();
  void UpdateColors();

  /// Gives a mapper the clip planes that are in use.
  void UpdateClipping(vtkVolumeMapper* mapper);

  DrawnArray Drawn;
  SurfaceColors Colors;
  vtkIsosurfaceBlocksMapper::Message Error, Warning; ///< of updates
  double WholeBounds[6];                             ///< of the pieces of all processes
  bool ResampleUnevenGrids = false;
  bool CanDraw = false;
  ClipPlane ClipPlanes[2];

  vtkProgressiveIsosurfaceRepresentation(const vtkProgressiveIsosurfaceRepresentation&) = delete;
  void operator=(const vtkProgressiveIsosurfaceRepresentation&) = delete;
};

#endif
