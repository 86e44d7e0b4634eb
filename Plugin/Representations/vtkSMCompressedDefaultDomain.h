// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMCompressedDefaultDomain
 * @brief   makes "Progressive Isosurface" the first representation of a compressed volume
 *
 * Hints of sources do that where the source is ours. A compressed volume from a file, or from a
 * filter that keeps it, comes from ParaView's own: when a representation that shows one is made,
 * this domain chooses its type in place of the outline of ParaView's default. Whatever the user has
 * chosen before stays.
 */

#ifndef vtkSMCompressedDefaultDomain_h
#define vtkSMCompressedDefaultDomain_h

#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSMDomain.h"

class VTKPROGISOREPRESENTATIONS_EXPORT vtkSMCompressedDefaultDomain : public vtkSMDomain
{
public:
  static vtkSMCompressedDefaultDomain* New();
  vtkTypeMacro(vtkSMCompressedDefaultDomain, vtkSMDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int SetDefaultValues(vtkSMProperty* property, bool useUnchecked) override;

protected:
  vtkSMCompressedDefaultDomain() = default;
  ~vtkSMCompressedDefaultDomain() override = default;

private:
  vtkSMCompressedDefaultDomain(const vtkSMCompressedDefaultDomain&) = delete;
  void operator=(const vtkSMCompressedDefaultDomain&) = delete;
};

#endif
