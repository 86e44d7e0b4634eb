// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqIsovaluesWidget
 * @brief   a slider that moves an isovalue live, above ParaView's table of them
 *
 * The slider moves the isovalue whose row is selected in the table, else the first. The surface
 * follows while it is dragged; a drag is one step to undo and one to trace.
 */
#ifndef pqIsovaluesWidget_h
#define pqIsovaluesWidget_h

#include "pqPropertyWidget.h"

#include <memory> // for ivar

class QAbstractItemView;
class pqDoubleRangeWidget;
class vtkSMDoubleRangeDomain;

class pqIsovaluesWidget : public pqPropertyWidget
{
  Q_OBJECT
  typedef pqPropertyWidget Superclass;

public:
  pqIsovaluesWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqIsovaluesWidget() override;

private Q_SLOTS:
  /// Shows the selected isovalue, and the range of the array.
  void showIsovalue();
  void showRange();

  ///@{
  /// Moves the selected isovalue, and the surface with it.
  void beginDrag();
  void dragTo(double isovalue);
  void moveTo(double isovalue);
  void endDrag();
  ///@}

private:
  void connectSlider();
  int selectedRow() const;
  void render(bool interactive);

  class Drag; // what belongs together for undo and trace
  std::unique_ptr<Drag> Dragged;
  pqDoubleRangeWidget* Slider;
  QAbstractItemView* Table = nullptr;
  vtkSMDoubleRangeDomain* Range = nullptr;
  bool Showing = false; ///< the slider moves to show a value, not to change it

  Q_DISABLE_COPY(pqIsovaluesWidget)
};

#endif
