// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqIsosurfaceCuttingWidget
 * @brief   cuts an isosurface open with a box and planes, each with a widget in the 3-D view
 *
 * Shows the property group of the clip planes, and before it the cropping box, whose properties are
 * ParaView's own for volumes. A check box switches each of them on, and shows its fields and its
 * 3-D widget.
 */
#ifndef pqIsosurfaceCuttingWidget_h
#define pqIsosurfaceCuttingWidget_h

#include "pqPropertyGroupWidget.h"

#include <vector> // for ivar

class QCheckBox;
class QVBoxLayout;

class pqIsosurfaceCuttingWidget : public pqPropertyGroupWidget
{
  Q_OBJECT
  typedef pqPropertyGroupWidget Superclass;

public:
  pqIsosurfaceCuttingWidget(
    vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqIsosurfaceCuttingWidget() override;

  ///@{
  /// Hand on to the widgets of box and planes.
  void apply() override;
  void reset() override;
  void select() override;
  void deselect() override;
  void updateWidget(bool showAdvanced) override;
  void setView(pqView* view) override;
  ///@}

private Q_SLOTS:
  /// Shows the fields of what is switched on, and its 3-D widget while the panel is in use.
  void showWhatCuts();

private:
  struct Cut
  {
    QCheckBox* Switch;
    pqPropertyWidget* Fields;
    bool IsNext; ///< of its kind, offered once the one before is used
  };

  void addBox(QVBoxLayout* layout);
  void addPlane(QVBoxLayout* layout, const QString& number, const QString& label, bool isNext);
  void addCut(QVBoxLayout* layout, vtkSMProperty* use, const QString& label, Cut cut);

  std::vector<Cut> Cuts;

  Q_DISABLE_COPY(pqIsosurfaceCuttingWidget)
};

#endif
