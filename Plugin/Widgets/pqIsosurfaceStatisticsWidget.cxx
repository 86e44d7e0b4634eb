// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqIsosurfaceStatisticsWidget.h"

#include "pqCoreUtilities.h"
#include "vtkCommand.h"
#include "vtkPVIsosurfaceInformation.h"
#include "vtkSMProgressiveIsosurfaceRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"

#include <QFormLayout>
#include <QHeaderView>
#include <QLabel>
#include <QProgressBar>
#include <QStringList>
#include <QTableWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace
{
constexpr int BAR_STEPS = 1000;
constexpr int ROWS_SHOWN = 5;

QString percent(double fraction)
{
  // round down: an image that lacks one pixel is not complete
  const double shown = fraction < 1.0 ? std::floor(1000.0 * fraction) / 10.0 : 100.0;
  return QString::number(shown, 'f', fraction < 1.0 ? 1 : 0) + " %";
}

QString largest(double fraction)
{
  // round up: an image with one uncertain pixel is not certain
  return QString::number(std::ceil(1000.0 * fraction) / 10.0, 'f', fraction > 0.0 ? 1 : 0) + " %";
}

QString mebibytes(double bytes)
{
  return QString::number(bytes / (1 << 20), 'f', 1);
}

// "0: 10.0 %, 1: 90.0 %", by how many pixels each level of detail draws
QString parts(const std::vector<double>& pixels, double all)
{
  QStringList levels;
  for (std::size_t level = 0; level < pixels.size(); ++level)
  {
    levels += QString("%1: %2").arg(level).arg(percent(pixels[level] / all));
  }
  return levels.join(", ");
}

QTableWidgetItem* number(const QString& text)
{
  auto* item = new QTableWidgetItem(text);
  item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  return item;
}
}

//-----------------------------------------------------------------------------
pqIsosurfaceStatisticsWidget::pqIsosurfaceStatisticsWidget(
  vtkSMProxy* smproxy, vtkSMPropertyGroup* group, QWidget* parentWidget)
  : Superclass(smproxy, group, parentWidget)
  , Summary(new QLabel(this))
  , Details(new QWidget(this))
  , Completed(new QProgressBar(this->Details))
  , Memory(new QProgressBar(this->Details))
  , Image(new QLabel(this->Details))
  , LevelsTitle(new QLabel(tr("Levels"), this->Details))
  , Levels(new QLabel(this->Details))
  , UncertainTitle(new QLabel(tr("Uncertain"), this->Details))
  , Uncertain(new QLabel(this->Details))
  , Passes(new QTableWidget(this->Details))
{
  this->setShowLabel(false);
  // the group belongs to the panel, its properties to the representation's proxy
  vtkSMProperty* first = group->GetNumberOfProperties() > 0 ? group->GetProperty(0u) : nullptr;
  this->Source = vtkSMProgressiveIsosurfaceRepresentationProxy::SafeDownCast(
    first ? first->GetParent() : nullptr);

  this->Summary->setObjectName("Summary");
  this->Summary->setWordWrap(true);
  this->Summary->setToolTip(
    tr("How far the last image has come, what it took, and graphics memory"));
  this->Completed->setObjectName("Completed");
  this->Completed->setRange(0, BAR_STEPS);
  this->Completed->setToolTip(tr("Part of the image that is complete"));
  this->Memory->setObjectName("Memory");
  this->Memory->setRange(0, BAR_STEPS);
  this->Memory->setToolTip(
    tr("Graphics memory beside the compressed volume, and the budget that bounds it"));
  this->Image->setObjectName("Image");
  this->Levels->setObjectName("Levels");
  this->Levels->setToolTip(tr("Part of the surface's pixels that each level of detail draws; level "
                              "0 is the volume itself"));
  this->Uncertain->setObjectName("Uncertain");
  this->Uncertain->setToolTip(
    tr("Part of the pixels within the volume's outline where coarser levels show nothing on the "
       "way and the volume itself may; none where Level Of Detail is Conservative"));
  this->makeTable();

  auto* form = new QFormLayout(this->Details);
  form->setContentsMargins(0, 0, 0, 0);
  form->addRow(tr("Completed"), this->Completed);
  form->addRow(tr("Memory"), this->Memory);
  form->addRow(tr("Image"), this->Image);
  form->addRow(this->LevelsTitle, this->Levels);
  form->addRow(this->UncertainTitle, this->Uncertain);
  form->addRow(this->Passes);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Summary);
  layout->addWidget(this->Details);
  this->updateWidget(false);

  if (this->Source)
  {
    pqCoreUtilities::connect(
      this->Source, vtkCommand::UpdateInformationEvent, this, SLOT(showStatistics()));
    this->showStatistics();
  }
}

//-----------------------------------------------------------------------------
pqIsosurfaceStatisticsWidget::~pqIsosurfaceStatisticsWidget() = default;

//-----------------------------------------------------------------------------
void pqIsosurfaceStatisticsWidget::updateWidget(bool showAdvanced)
{
  this->Superclass::updateWidget(showAdvanced);
  this->Summary->setVisible(!showAdvanced);
  this->Details->setVisible(showAdvanced);
}

//-----------------------------------------------------------------------------
void pqIsosurfaceStatisticsWidget::makeTable()
{
  this->Passes->setObjectName("Passes");
  this->Passes->setColumnCount(3);
  this->Passes->setHorizontalHeaderLabels({ tr("Pass"), tr("Time (ms)"), tr("Completed") });
  this->Passes->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  this->Passes->verticalHeader()->hide();
  this->Passes->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->Passes->setSelectionMode(QAbstractItemView::NoSelection);
  this->Passes->setFocusPolicy(Qt::NoFocus);
}

//-----------------------------------------------------------------------------
void pqIsosurfaceStatisticsWidget::showStatistics()
{
  if (!this->Source)
  {
    return;
  }
  vtkPVIsosurfaceInformation* statistics = this->Source->GetStatistics();
  const double completed = statistics->GetCompletedFraction();
  this->Completed->setValue(static_cast<int>(BAR_STEPS * completed));
  this->Completed->setFormat(percent(completed));
  const int passes = statistics->GetNumberOfPasses();
  QString image = (passes == 1 ? tr("%1 pass, %2 ms") : tr("%1 passes, %2 ms"))
                    .arg(passes)
                    .arg(statistics->GetTotalMilliseconds(), 0, 'f', 1);
  if (statistics->GetNumberOfProcesses() > 1)
  {
    image += tr(", %1 processes").arg(statistics->GetNumberOfProcesses());
  }
  this->Image->setText(image);
  this->showMemory(statistics);
  this->Summary->setText(passes == 0
      ? tr("No image yet")
      : tr("%1 complete: %2; %3 used%4")
          .arg(percent(completed), image, this->Memory->text(), this->showLevels(statistics)));
  this->showPasses(statistics);
}

//-----------------------------------------------------------------------------
QString pqIsosurfaceStatisticsWidget::showLevels(vtkPVIsosurfaceInformation* statistics)
{
  const std::vector<double>& pixels = statistics->GetLevelPixels();
  const double all = std::accumulate(pixels.begin(), pixels.end(), 0.0);
  const bool several = pixels.size() > 1 && all > 0.0;
  for (QLabel* label : { this->LevelsTitle, this->Levels, this->UncertainTitle, this->Uncertain })
  {
    label->setVisible(several);
  }
  if (!several)
  {
    return QString();
  }
  this->Levels->setText(parts(pixels, all));
  const double uncertain = statistics->GetUncertainFraction();
  this->Uncertain->setText(largest(uncertain));
  const QString coarse = percent(1.0 - pixels[0] / all);
  return uncertain > 0.0 ? tr("; %1 of the surface from coarser levels, %2 of the pixels uncertain")
                             .arg(coarse, largest(uncertain))
                         : tr("; %1 of the surface from coarser levels").arg(coarse);
}

//-----------------------------------------------------------------------------
void pqIsosurfaceStatisticsWidget::showMemory(vtkPVIsosurfaceInformation* statistics)
{
  const double held = statistics->GetGPUBytes() - statistics->GetCompressedBytes();
  const double budget = statistics->GetMemoryBudget();
  this->Memory->setValue(budget > 0.0 ? static_cast<int>(BAR_STEPS * held / budget) : 0);
  this->Memory->setFormat(tr("%1 of %2 MiB").arg(mebibytes(held), mebibytes(budget)));
}

//-----------------------------------------------------------------------------
void pqIsosurfaceStatisticsWidget::showPasses(vtkPVIsosurfaceInformation* statistics)
{
  const std::vector<double>& ends = statistics->GetPassMilliseconds();
  const std::vector<double>& completed = statistics->GetPassCompleted();
  const int passes = statistics->GetNumberOfPasses();
  this->Passes->setRowCount(passes);
  for (int pass = 0; pass < passes; ++pass)
  {
    const double taken = ends[pass] - (pass > 0 ? ends[pass - 1] : 0.0);
    this->Passes->setItem(pass, 0, number(QString::number(pass + 1)));
    this->Passes->setItem(pass, 1, number(QString::number(taken, 'f', 2)));
    this->Passes->setItem(pass, 2, number(percent(completed[pass])));
  }
  const int row = this->Passes->verticalHeader()->defaultSectionSize();
  this->Passes->setFixedHeight((std::clamp(passes, 1, ROWS_SHOWN) + 1) * row);
  this->Passes->scrollToBottom();
}
