// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMProgressiveIsosurfaceRepresentationProxy
 * @brief   keeps the figures of a progressive isosurface up to date
 *
 * ParaView asks a representation for its information properties when its data change. Passes,
 * completed fraction and times change with every image instead, so this proxy asks after each image
 * of the view that shows it. It asks all processes that draw, wherever they are: ParaView's own way
 * ends at the client, which in remote rendering draws nothing. What they say is in the information
 * properties and, pass by pass, in GetStatistics(); observers hear of news by
 * UpdateInformationEvent. It warns, once, where no isovalue lies in the array's range.
 */

#ifndef vtkSMProgressiveIsosurfaceRepresentationProxy_h
#define vtkSMProgressiveIsosurfaceRepresentationProxy_h

#include "vtkNew.h"                          // for ivar
#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSMRepresentationProxy.h"
#include "vtkWeakPointer.h" // for ivar

class vtkPVIsosurfaceInformation;

class VTKPROGISOREPRESENTATIONS_EXPORT vtkSMProgressiveIsosurfaceRepresentationProxy
  : public vtkSMRepresentationProxy
{
public:
  static vtkSMProgressiveIsosurfaceRepresentationProxy* New();
  vtkTypeMacro(vtkSMProgressiveIsosurfaceRepresentationProxy, vtkSMRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void ViewUpdated(vtkSMProxy* view) override;

  /// What was last gathered. UpdatePropertyInformation() gathers anew.
  vtkPVIsosurfaceInformation* GetStatistics();

protected:
  vtkSMProgressiveIsosurfaceRepresentationProxy();
  ~vtkSMProgressiveIsosurfaceRepresentationProxy() override;

  void UpdatePropertyInformationInternal(vtkSMProperty* property) override;

private:
  /// After an image of the view.
  void OnImage();

  /// Whether this is how the data are shown: as one of several representations, of which one is
  /// active.
  bool IsActive();

  /// Says so where all isovalues lie outside the values of the array, as soon as they do.
  void WarnOfNothing();

  void StopObserving();

  vtkNew<vtkPVIsosurfaceInformation> Statistics;
  vtkWeakPointer<vtkSMProxy> View;
  unsigned long ImageObserver = 0;
  bool Warned = false;

  vtkSMProgressiveIsosurfaceRepresentationProxy(
    const vtkSMProgressiveIsosurfaceRepresentationProxy&) = delete;
  void operator=(const vtkSMProgressiveIsosurfaceRepresentationProxy&) = delete;
};

#endif
