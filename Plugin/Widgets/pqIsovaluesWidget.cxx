// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqIsovaluesWidget.h"

#include "pqCoreUtilities.h"
#include "pqDoubleRangeWidget.h"
#include "pqScalarValueListPropertyWidget.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkCommand.h"
#include "vtkSMDoubleRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMViewProxy.h"

#include <QAbstractItemView>
#include <QItemSelectionModel>
#include <QSlider>
#include <QVBoxLayout>

namespace
{
constexpr int SLIDER_STEPS = 1000;
}

// One step to undo, and one line of trace, for as long as it lives.
class pqIsovaluesWidget::Drag
{
public:
  explicit Drag(vtkSMProxy* proxy)
    : Undo(tr("Isovalue"))
    , Trace("PropertiesModified")
  {
    this->Trace = vtkSMTrace::TraceItemArgs().arg("proxy", proxy);
  }

private:
  pqScopedUndoSet Undo;
  vtkSMTrace::TraceItem Trace;
};

//-----------------------------------------------------------------------------
pqIsovaluesWidget::pqIsovaluesWidget(
  vtkSMProxy* smproxy, vtkSMProperty* smproperty, QWidget* parentWidget)
  : Superclass(smproxy, parentWidget)
  , Slider(new pqDoubleRangeWidget(this))
  , Range(smproperty->FindDomain<vtkSMDoubleRangeDomain>())
{
  this->setShowLabel(false);
  auto* list = new pqScalarValueListPropertyWidget(smproperty, smproxy, this);
  list->setObjectName("ScalarValueList");
  list->setRangeDomain(this->Range);
  this->addPropertyLink(list, "scalars", SIGNAL(scalarsChanged()), smproperty);
  this->Table = list->findChild<QAbstractItemView*>("Table");

  this->Slider->setObjectName("IsovalueSlider");
  this->Slider->setResolution(SLIDER_STEPS);
  this->Slider->setUseGlobalPrecisionAndNotation(true);
  this->Slider->setToolTip(tr("Moves the selected isovalue"));

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Slider);
  layout->addWidget(list);

  pqCoreUtilities::connect(smproperty, vtkCommand::ModifiedEvent, this, SLOT(showIsovalue()));
  if (this->Range)
  {
    pqCoreUtilities::connect(smproperty, vtkCommand::DomainModifiedEvent, this, SLOT(showRange()));
  }
  this->setProperty(smproperty);
  this->showRange();
  this->connectSlider();
}

//-----------------------------------------------------------------------------
pqIsovaluesWidget::~pqIsovaluesWidget() = default;

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::connectSlider()
{
  // what is typed counts when it is complete, a drag all the way
  this->connect(this->Slider, SIGNAL(valueChanged(double)), SLOT(dragTo(double)));
  this->connect(this->Slider, SIGNAL(valueEdited(double)), SLOT(moveTo(double)));
  auto* handle = this->Slider->findChild<QSlider*>();
  this->connect(handle, SIGNAL(sliderPressed()), SLOT(beginDrag()));
  this->connect(handle, SIGNAL(sliderReleased()), SLOT(endDrag()));
  if (this->Table)
  {
    this->connect(this->Table->selectionModel(),
      SIGNAL(currentChanged(const QModelIndex&, const QModelIndex&)), SLOT(showIsovalue()));
  }
}

//-----------------------------------------------------------------------------
int pqIsovaluesWidget::selectedRow() const
{
  const int isovalues =
    static_cast<int>(vtkSMPropertyHelper(this->property()).GetNumberOfElements());
  const QModelIndex current = this->Table ? this->Table->currentIndex() : QModelIndex();
  return current.isValid() && current.row() < isovalues ? current.row() : 0;
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::showRange()
{
  int hasLowest = 0, hasHighest = 0;
  const double lowest = this->Range ? this->Range->GetMinimum(0, hasLowest) : 0.0;
  const double highest = this->Range ? this->Range->GetMaximum(0, hasHighest) : 0.0;
  const bool known = hasLowest && hasHighest && lowest < highest;
  this->Slider->setVisible(known);
  if (known)
  {
    this->Showing = true;
    this->Slider->setMinimum(lowest);
    this->Slider->setMaximum(highest);
    this->Showing = false;
  }
  this->showIsovalue();
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::showIsovalue()
{
  vtkSMPropertyHelper isovalues(this->property());
  const bool some = isovalues.GetNumberOfElements() > 0;
  this->Slider->setEnabled(some);
  if (some && !this->Dragged)
  {
    this->Showing = true;
    this->Slider->setValue(isovalues.GetAsDouble(this->selectedRow()));
    this->Showing = false;
  }
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::beginDrag()
{
  this->Dragged.reset(new Drag(this->proxy()));
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::dragTo(double isovalue)
{
  if (this->Dragged)
  {
    this->moveTo(isovalue);
  }
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::moveTo(double isovalue)
{
  vtkSMPropertyHelper isovalues(this->property());
  const unsigned int row = this->selectedRow();
  if (this->Showing || row >= isovalues.GetNumberOfElements() ||
    isovalues.GetAsDouble(row) == isovalue)
  {
    return;
  }
  const bool step = !this->Dragged; // by keyboard or wheel
  if (step)
  {
    this->beginDrag();
  }
  isovalues.Set(row, isovalue);
  this->proxy()->UpdateVTKObjects();
  if (step)
  {
    this->endDrag();
  }
  else
  {
    this->render(true);
  }
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::endDrag()
{
  this->Dragged.reset();
  this->showIsovalue();
  this->render(false);
}

//-----------------------------------------------------------------------------
void pqIsovaluesWidget::render(bool interactive)
{
  if (!this->view())
  {
    return;
  }
  if (interactive)
  {
    this->view()->getViewProxy()->InteractiveRender();
  }
  else
  {
    this->view()->render();
  }
}
