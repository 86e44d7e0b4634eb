// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMIsovalueDomain
 * @brief   range of an isovalue
 *
 * For plain image data this is the range of the chosen array (the required property
 * "ArraySelection"), as vtkSMArrayRangeDomain finds it. A compressed volume has no such array, but
 * keeps the range of the original values as field data. Without either the domain is empty.
 */

#ifndef vtkSMIsovalueDomain_h
#define vtkSMIsovalueDomain_h

#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSMArrayRangeDomain.h"

class vtkPVArrayInformation;
class vtkSMProperty;

class VTKPROGISOREPRESENTATIONS_EXPORT vtkSMIsovalueDomain : public vtkSMArrayRangeDomain
{
public:
  static vtkSMIsovalueDomain* New();
  vtkTypeMacro(vtkSMIsovalueDomain, vtkSMArrayRangeDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* property) override;

  /// Finds the range of a compressed volume as ParaView has gathered it; null if what is connected
  /// to an input property is no compressed volume.
  static vtkPVArrayInformation* FindCompressedRange(vtkSMProperty* input);

protected:
  vtkSMIsovalueDomain() = default;
  ~vtkSMIsovalueDomain() override = default;

private:
  vtkSMIsovalueDomain(const vtkSMIsovalueDomain&) = delete;
  void operator=(const vtkSMIsovalueDomain&) = delete;
};

#endif
