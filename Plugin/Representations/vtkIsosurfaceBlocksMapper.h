// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsosurfaceBlocksMapper
 * @brief   isosurfaces of one image, or of all images of a partitioned data set
 *
 * Has a vtkProgressiveIsosurfaceMapper for each image and draws with one after the other. All take
 * over GetSettings(), and the clipping planes and the cropping of this mapper. They share the
 * memory budget by their numbers of samples, and the time of a frame. Translucent blocks are drawn
 * from back to front.
 */
#ifndef vtkIsosurfaceBlocksMapper_h
#define vtkIsosurfaceBlocksMapper_h

#include "vtkNew.h"          // for ivar
#include "vtkSmartPointer.h" // for ivar
#include "vtkVolumeMapper.h"

#include <cstddef>
#include <string>
#include <vector>

class vtkProgressiveIsosurfaceMapper;
class vtkRenderWindow;
class vtkVolumeProperty;

class vtkIsosurfaceBlocksMapper : public vtkVolumeMapper
{
public:
  static vtkIsosurfaceBlocksMapper* New();
  vtkTypeMacro(vtkIsosurfaceBlocksMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// A mapper that draws nothing: all others take over its properties.
  vtkProgressiveIsosurfaceMapper* GetSettings() { return this->Settings; }

  using Mappers = std::vector<vtkSmartPointer<vtkProgressiveIsosurfaceMapper>>;

  /// The mappers of the blocks that the last render drew: of several, those in whose range an
  /// isovalue is.
  const Mappers& GetMappers() const { return this->Drawn; }

  /// Side of the squares of pixels that share a ray while the camera moves, where an image of full
  /// resolution would take longer than the settings' TimeAllowance; up to twice as long where the
  /// last one took too long, too. 1: there are no such images.
  void SetMovingReductionFactor(int factor) { this->MovingReductionFactor = factor; }

  /// Prepares the inputs of the blocks that the next render draws with a property; false: one of
  /// them cannot be drawn.
  bool UpdateInputs(vtkVolumeProperty* property);

  /// What a block's mapper has told last, and how many messages there were before and with it. The
  /// mappers do not print them. An error is empty once all blocks are drawn.
  struct Message
  {
    std::string Text;
    int Count = 0;
  };
  const Message& GetError() const { return this->Error; }
  const Message& GetWarning() const { return this->Warning; }

  ///@{
  /// See vtkVolumeMapper. The input for pickers is the one image, if it is one.
  vtkDataSet* GetDataSetInput() override;
  double* GetBounds() VTK_SIZEHINT(6) override;
  using vtkVolumeMapper::GetBounds;
  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;
  ///@}

protected:
  vtkIsosurfaceBlocksMapper();
  ~vtkIsosurfaceBlocksMapper() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  /// Gives each image of the input a mapper with the settings, and finds those that draw. Those of
  /// images that have gone are released.
  void UpdateMappers(vtkVolumeProperty* property);
  void UpdateSettings();
  /// The time of a render, for all blocks. A still one is completed at once but in ParaView's own
  /// window: a Python program's may have no event loop, which would go on with it.
  double FindTime(vtkRenderWindow* window);
  int FindReduction(vtkRenderWindow* window);
  std::vector<std::size_t> FindOrder(vtkRenderer* renderer, vtkVolume* volume);
  /// Called for an error or a warning of a block's mapper, with VTK's text of it.
  void Keep(vtkObject* mapper, unsigned long event, void* text);
  void CountComplete() { ++this->NumberOfComplete; }
  /// Hands on the event of a block that is compressed or loaded, with the fraction of all blocks.
  void OnProgress(vtkObject* mapper, unsigned long event, void* fraction);

  vtkNew<vtkProgressiveIsosurfaceMapper> Settings;
  Mappers All;   ///< one for each block
  Mappers Drawn; ///< of these, those in whose range an isovalue is
  int MovingReductionFactor = 1;
  Message Error, Warning;
  std::size_t NumberOfComplete = 0; ///< blocks that the last render could draw

  vtkIsosurfaceBlocksMapper(const vtkIsosurfaceBlocksMapper&) = delete;
  void operator=(const vtkIsosurfaceBlocksMapper&) = delete;
};

#endif
