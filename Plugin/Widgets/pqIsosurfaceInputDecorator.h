// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqIsosurfaceInputDecorator
 * @brief   hides what does nothing for the present input of a progressive isosurface
 *
 * Shows its widget only
 * @li with `input="plain"`: for an image that is compressed here; a compressed volume has its array
 *     and rate,
 * @li with `components="several"`: if the isosurface array offers a choice of components.
 */
#ifndef pqIsosurfaceInputDecorator_h
#define pqIsosurfaceInputDecorator_h

#include "pqPropertyWidgetDecorator.h"
#include "vtkWeakPointer.h" // for ivar

class vtkSMProperty;
class vtkSMProxy;

class pqIsosurfaceInputDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  typedef pqPropertyWidgetDecorator Superclass;

public:
  pqIsosurfaceInputDecorator(vtkPVXMLElement* config, pqPropertyWidget* parent);
  ~pqIsosurfaceInputDecorator() override;

  bool canShowWidget(bool showAdvanced) const override;

private Q_SLOTS:
  /// Follows the source that is shown, and asks the panel to look again.
  void followInput();

private:
  bool wants(const char* attribute, const char* value) const;

  vtkWeakPointer<vtkSMProperty> Input;
  vtkWeakPointer<vtkSMProperty> Component;
  vtkWeakPointer<vtkSMProxy> Source;

  Q_DISABLE_COPY(pqIsosurfaceInputDecorator)
};

#endif
