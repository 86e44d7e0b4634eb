// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMIsovalueDomain
 * @brief   range of the values that an isovalue can take
 *
 * For plain image data the range is that of the chosen array (the required property
 * "ArraySelection"), as vtkSMArrayRangeDomain finds it. A compressed volume has no such array: its
 * range is that of the original values, which it carries as field data. Without either the domain
 * is empty.
 */

#ifndef vtkSMIsovalueDomain_h
#define vtkSMIsovalueDomain_h

#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSMArrayRangeDomain.h"

class vtkPVArrayInformation;

class VTKPROGISOREPRESENTATIONS_EXPORT vtkSMIsovalueDomain : public vtkSMArrayRangeDomain
{
public:
  static vtkSMIsovalueDomain* New();
  vtkTypeMacro(vtkSMIsovalueDomain, vtkSMArrayRangeDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* property) override;

protected:
  vtkSMIsovalueDomain() = default;
  ~vtkSMIsovalueDomain() override = default;

private:
  /// The compressed volume's range as ParaView has gathered it, or nullptr when the input is no
  /// compressed volume.
  vtkPVArrayInformation* FindCompressedRange();

  vtkSMIsovalueDomain(const vtkSMIsovalueDomain&) = delete;
  void operator=(const vtkSMIsovalueDomain&) = delete;
};

#endif
