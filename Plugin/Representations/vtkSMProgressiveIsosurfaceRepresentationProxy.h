// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMProgressiveIsosurfaceRepresentationProxy
 * @brief   keeps the statistics of a progressive isosurface up to date
 *
 * ParaView updates the information properties of a representation when its data change. Passes,
 * completed fraction and times change with every image, so this proxy updates them after each image
 * of its view. It gathers them from all processes that draw: ParaView would ask only the client,
 * which draws nothing in remote rendering. The information properties hold the result, and
 * GetStatistics() each pass of it; UpdateInformationEvent tells observers of changes. The proxy
 * takes over isovalues that are set as those of ParaView's Volume are, while this representation is
 * the active one. It tells what has gone wrong on any process, and warns if no isovalue lies in the
 * array's range, both once.
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

  /// The statistics as last gathered; UpdatePropertyInformation() gathers them again.
  vtkPVIsosurfaceInformation* GetStatistics();

protected:
  vtkSMProgressiveIsosurfaceRepresentationProxy();
  ~vtkSMProgressiveIsosurfaceRepresentationProxy() override;

  void UpdatePropertyInformationInternal(vtkSMProperty* property) override;
  void SetPropertyModifiedFlag(const char* name, int flag) override;

private:
  /// Called after an image of the view.
  void OnImage();

  /// Copies IsosurfaceValues, which ParaView's Volume has, to Isovalues.
  void TakeOverIsosurfaceValues();

  /// Whether this is the active one of the representations of the data.
  bool IsActive();

  /// Tells what any process has found wrong since the last image, here where the user is.
  void TellMessages();

  /// Warns when all isovalues have come to lie outside the range of the array.
  void WarnIfNothingShows();

  void StopObserving();

  vtkNew<vtkPVIsosurfaceInformation> Statistics;
  vtkWeakPointer<vtkSMProxy> View;
  unsigned long ImageObserver = 0;
  bool Warned = false;
  int ToldErrors = 0;
  int ToldWarnings = 0;

  vtkSMProgressiveIsosurfaceRepresentationProxy(
    const vtkSMProgressiveIsosurfaceRepresentationProxy&) = delete;
  void operator=(const vtkSMProgressiveIsosurfaceRepresentationProxy&) = delete;
};

#endif
