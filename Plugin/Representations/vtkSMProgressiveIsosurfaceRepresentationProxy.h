// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMProgressiveIsosurfaceRepresentationProxy
 * @brief   keeps the figures of a progressive isosurface up to date
 *
 * ParaView asks a representation for its information properties when its data change. Passes,
 * completed fraction and times change with every image instead, so this proxy asks after each image
 * of the view that shows it.
 */

#ifndef vtkSMProgressiveIsosurfaceRepresentationProxy_h
#define vtkSMProgressiveIsosurfaceRepresentationProxy_h

#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSMRepresentationProxy.h"
#include "vtkWeakPointer.h" // for ivar

class VTKPROGISOREPRESENTATIONS_EXPORT vtkSMProgressiveIsosurfaceRepresentationProxy
  : public vtkSMRepresentationProxy
{
public:
  static vtkSMProgressiveIsosurfaceRepresentationProxy* New();
  vtkTypeMacro(vtkSMProgressiveIsosurfaceRepresentationProxy, vtkSMRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void ViewUpdated(vtkSMProxy* view) override;

protected:
  vtkSMProgressiveIsosurfaceRepresentationProxy() = default;
  ~vtkSMProgressiveIsosurfaceRepresentationProxy() override;

private:
  /// After an image of the view.
  void OnImage();

  /// Whether this is how the data are shown: as one of several representations, of which one is
  /// active.
  bool IsActive();

  void StopObserving();

  vtkWeakPointer<vtkSMProxy> View;
  unsigned long ImageObserver = 0;

  vtkSMProgressiveIsosurfaceRepresentationProxy(
    const vtkSMProgressiveIsosurfaceRepresentationProxy&) = delete;
  void operator=(const vtkSMProgressiveIsosurfaceRepresentationProxy&) = delete;
};

#endif
