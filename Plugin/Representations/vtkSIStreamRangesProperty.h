// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSIStreamRangesProperty
 * @brief   makes a reader of ParaView's give streams whose ranges are known at once
 *
 * ParaView asks for the ranges of all arrays that a reader has read, and VTK looks at every byte of
 * a usual array for them, some 20 ns long. Has no value: being one of a reader's properties it
 * looks at what the reader has read, and changes the arrays of compressed streams, see
 * vtkCompressedVolume::SpeedUpRanges().
 */
#ifndef vtkSIStreamRangesProperty_h
#define vtkSIStreamRangesProperty_h

#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSIProperty.h"

class VTKPROGISOREPRESENTATIONS_EXPORT vtkSIStreamRangesProperty : public vtkSIProperty
{
public:
  static vtkSIStreamRangesProperty* New();
  vtkTypeMacro(vtkSIStreamRangesProperty, vtkSIProperty);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSIStreamRangesProperty() = default;
  ~vtkSIStreamRangesProperty() override = default;

  bool ReadXMLAttributes(vtkSIProxy* proxy, vtkPVXMLElement* element) override;

private:
  vtkSIStreamRangesProperty(const vtkSIStreamRangesProperty&) = delete;
  void operator=(const vtkSIStreamRangesProperty&) = delete;
};

#endif
