// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqIsosurfaceCuttingWidget.h"

#include "pqBoxPropertyWidget.h"
#include "pqImplicitPlanePropertyWidget.h"
#include "vtkNew.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMProxy.h"

#include <QCheckBox>
#include <QVBoxLayout>

//-----------------------------------------------------------------------------
pqIsosurfaceCuttingWidget::pqIsosurfaceCuttingWidget(
  vtkSMProxy* smproxy, vtkSMPropertyGroup* group, QWidget* parentWidget)
  : Superclass(smproxy, group, parentWidget)
{
  this->setShowLabel(false);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  this->addBox(layout);
  this->addPlane(layout, "", tr("Clip Plane"), false);
  this->addPlane(layout, "2", tr("Second Clip Plane"), true);
  this->showWhatCuts();
}

//-----------------------------------------------------------------------------
pqIsosurfaceCuttingWidget::~pqIsosurfaceCuttingWidget() = default;

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::addBox(QVBoxLayout* layout)
{
  vtkSMProxy* whole = this->proxy();
  vtkSMProperty* use = whole->GetProperty("UseCropping");
  vtkSMProperty* origin = whole->GetProperty("CroppingOrigin");
  vtkSMProperty* scale = whole->GetProperty("CroppingScale");
  vtkSMProperty* input = whole->GetProperty("Input");
  if (!use || !origin || !scale || !input)
  {
    return; // not all kinds of data have a cropping box in ParaView
  }
  vtkNew<vtkSMPropertyGroup> box;
  box->AddProperty("Position", origin);
  box->AddProperty("Scale", scale);
  box->AddProperty("Input", input);
  this->addCut(layout, use, tr("Cropping Box"),
    { nullptr, new pqBoxPropertyWidget(whole, box, this, /*hideReferenceBounds=*/true), false });
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::addPlane(
  QVBoxLayout* layout, const QString& number, const QString& label, bool isNext)
{
  vtkSMProxy* whole = this->proxy();
  const auto find = [&](const QString& name)
  { return this->propertyGroup()->GetProperty((name + number).toUtf8().constData()); };
  vtkNew<vtkSMPropertyGroup> plane;
  plane->AddProperty("Origin", find("ClipPlaneOrigin"));
  plane->AddProperty("Normal", find("ClipPlaneNormal"));
  plane->AddProperty("Input", whole->GetProperty("Input"));
  this->addCut(layout, find("UseClipPlane"), label,
    { nullptr, new pqImplicitPlanePropertyWidget(whole, plane, this), isNext });
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::addCut(
  QVBoxLayout* layout, vtkSMProperty* use, const QString& label, Cut cut)
{
  cut.Switch = new QCheckBox(label, this);
  cut.Switch->setObjectName(use->GetXMLName());
  cut.Switch->setToolTip(pqPropertyWidget::getTooltip(use));
  cut.Fields->setObjectName(QString(use->GetXMLName()) + "Fields");
  layout->addWidget(cut.Switch);
  layout->addWidget(cut.Fields);
  this->addPropertyLink(cut.Switch, "checked", SIGNAL(toggled(bool)), use);
  this->connect(cut.Switch, SIGNAL(toggled(bool)), SLOT(showWhatCuts()));
  this->connect(cut.Fields, SIGNAL(changeAvailable()), SIGNAL(changeAvailable()));
  this->connect(cut.Fields, SIGNAL(changeFinished()), SIGNAL(changeFinished()));
  this->Cuts.push_back(cut);
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::showWhatCuts()
{
  bool usedBefore = true;
  for (const Cut& cut : this->Cuts)
  {
    const bool used = cut.Switch->isChecked();
    cut.Switch->setVisible(used || usedBefore || !cut.IsNext);
    cut.Fields->setVisible(used);
    if (used && this->isSelected())
    {
      cut.Fields->select();
    }
    else
    {
      cut.Fields->deselect();
    }
    usedBefore = used;
  }
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::apply()
{
  this->Superclass::apply();
  for (const Cut& cut : this->Cuts)
  {
    cut.Fields->apply();
  }
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::reset()
{
  this->Superclass::reset();
  for (const Cut& cut : this->Cuts)
  {
    cut.Fields->reset();
  }
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::select()
{
  this->Superclass::select();
  this->showWhatCuts();
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::deselect()
{
  this->Superclass::deselect();
  this->showWhatCuts();
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::updateWidget(bool showAdvanced)
{
  this->Superclass::updateWidget(showAdvanced);
  for (const Cut& cut : this->Cuts)
  {
    cut.Fields->updateWidget(showAdvanced);
  }
}

//-----------------------------------------------------------------------------
void pqIsosurfaceCuttingWidget::setView(pqView* pqview)
{
  this->Superclass::setView(pqview);
  for (const Cut& cut : this->Cuts)
  {
    cut.Fields->setView(pqview);
  }
}
