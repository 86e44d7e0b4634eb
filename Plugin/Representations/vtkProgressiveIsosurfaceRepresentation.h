// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkProgressiveIsosurfaceRepresentation
 * @brief   ParaView representation of image data as a progressive isosurface
 *
 * Shows plain image data and compressed volumes (see vtkCompressedVolume) through
 * vtkProgressiveIsosurfaceMapper. Opaque surfaces are drawn in the opaque pass, where translucent
 * geometry blends over them, and ask for no ordered compositing; translucent ones are drawn with
 * the volumes. Colour: the colour map at the isovalue when the representation is coloured by the
 * array that is drawn, the solid colour otherwise.
 *
 * Image data only: rectilinear grids and composite data are refused with an error.
 *
 * Where several processes share an image, each draws its own piece, and ParaView composites them. A
 * process takes with its piece the samples around it that normals need, in whole blocks of the
 * whole image, so that every process decodes the same values and no seam shows: it asks the
 * pipeline for ghost levels, and where that has none, exchanges them with the others.
 */

#ifndef vtkProgressiveIsosurfaceRepresentation_h
#define vtkProgressiveIsosurfaceRepresentation_h

#include "vtkImageVolumeRepresentation.h"
#include "vtkProgIsoRepresentationsModule.h" // for export macro

#include <string> // for ivar

class vtkImageData;
class vtkProgressiveIsosurfaceMapper;
class vtkProgressiveIsosurfaceStatistics;

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
   * The array to draw an isosurface of, in plain image data; empty: the active scalars. A
   * compressed volume holds one array and ignores this. The signature is that of ParaView's array
   * selection properties.
   */
  void SetIsosurfaceArray(int index, int port, int connection, int association, const char* name);

  /// The component of that array.
  void SetIsosurfaceComponent(int component);

  ///@{
  /// The isovalues, in the units of the array; they become those of the volume property.
  void SetNumberOfIsovalues(int number);
  void SetIsovalue(int index, double value);
  ///@}

  /// Colour of the surface where no colour map applies.
  void SetDiffuseColor(double red, double green, double blue);

  /// Opacity of the surface, 0 … 1. A colour map that maps opacities has a say too.
  void SetOpacity(double opacity);

  /// Colour map, used when the representation is coloured by the isosurface array, or by another
  /// one of a plain image that has the same association.
  void SetColor(vtkColorTransferFunction* colorMap);

  using Superclass::SetInputArrayToProcess;
  /// The array to colour by.
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;

  ///@{
  /**
   * Forwarded to the mapper: bits per voxel for plain data, whether their NaN is hidden,
   * speculation on or off, and the memory budget in mebibytes (0: automatic).
   */
  void SetRate(double bitsPerVoxel);
  void SetMaskNonFinite(bool on);
  void SetSpeculation(bool on);
  void SetMemoryBudget(int mebibytes);
  ///@}

  ///@{
  /// What draws the surface on this process, and the statistics of its last image. See
  /// vtkPVIsosurfaceInformation for those of all processes.
  vtkProgressiveIsosurfaceMapper* GetIsosurfaceMapper();
  vtkProgressiveIsosurfaceStatistics* GetStatistics();
  ///@}

protected:
  vtkProgressiveIsosurfaceRepresentation();
  ~vtkProgressiveIsosurfaceRepresentation() override;

  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  void UpdateMapperParameters() override;

private:
  /// An array of the input by association and name.
  struct ArraySelection
  {
    int Association = 0; // vtkDataObject::FIELD_ASSOCIATION_POINTS
    std::string Name;
  };

  ///@{
  /// Sets DrawnArray from the input; false after an error that says why nothing can be drawn.
  bool FindDrawnArray(vtkImageData* image);
  bool FindCompressedArray(vtkImageData* image);
  bool FindPlainArray(vtkImageData* image);
  ///@}

  ///@{
  /// What this process draws of its input: with several processes, its piece and what it needs of
  /// the samples around it.
  vtkSmartPointer<vtkImageData> MakePiece(vtkImageData* image);
  vtkSmartPointer<vtkImageData> MakeCompressedPiece(vtkImageData* image, const int own[6]);
  vtkSmartPointer<vtkImageData> MakePlainPiece(vtkImageData* image, const int own[6]);
  vtkSmartPointer<vtkImageData> SelectDrawnArray(vtkImageData* image);
  ///@}

  /// Take over what is drawn, and its outline and size.
  void SetPiece(vtkImageData* piece, const int own[6]);

  /// True when the representation is coloured by the array that is drawn.
  bool IsColoredByDrawnArray();

  ///@{
  /// The array that gives the colours in place of the one that is drawn.
  std::string FindOtherColorArray(vtkImageData* image);
  void UpdateColors();
  ///@}

  /// Sets the property's colours, and its opacities: a function with one node an isovalue.
  void UpdateLook();

  ArraySelection IsosurfaceArray; ///< as chosen by the user, its name empty for the active scalars
  ArraySelection DrawnArray;      ///< the array of the present input
  vtkSmartPointer<vtkColorTransferFunction> ColorMap;
  vtkNew<vtkColorTransferFunction> SolidColor;
  double Opacity = 1.0;
  vtkNew<vtkPiecewiseFunction> SurfaceOpacity;
  bool CanDraw = false;

  vtkProgressiveIsosurfaceRepresentation(const vtkProgressiveIsosurfaceRepresentation&) = delete;
  void operator=(const vtkProgressiveIsosurfaceRepresentation&) = delete;
};

#endif
