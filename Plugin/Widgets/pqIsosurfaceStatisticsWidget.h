// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqIsosurfaceStatisticsWidget
 * @brief   shows in ParaView's panel how a progressive isosurface refines
 *
 * Shows the property group of a progressive isosurface's statistics: how much of the image is
 * complete, memory and its budget, how much of the surface coarser levels of detail draw and where
 * they may hide something, in a line; with advanced properties also the passes with their times,
 * and the part of each level. It follows its vtkSMProgressiveIsosurfaceRepresentationProxy, which
 * gathers the statistics after every image, and changes nothing.
 */

#ifndef pqIsosurfaceStatisticsWidget_h
#define pqIsosurfaceStatisticsWidget_h

#include "pqPropertyGroupWidget.h"
#include "vtkWeakPointer.h" // for ivar

class QLabel;
class QProgressBar;
class QTableWidget;
class vtkPVIsosurfaceInformation;
class vtkSMProgressiveIsosurfaceRepresentationProxy;

class pqIsosurfaceStatisticsWidget : public pqPropertyGroupWidget
{
  Q_OBJECT
  typedef pqPropertyGroupWidget Superclass;

public:
  pqIsosurfaceStatisticsWidget(
    vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqIsosurfaceStatisticsWidget() override;

  void updateWidget(bool showAdvanced) override;

private Q_SLOTS:
  /// Shows what the proxy has gathered.
  void showStatistics();

private:
  void makeTable();
  void showMemory(vtkPVIsosurfaceInformation* statistics);
  /// Returns what the line says of them, which is nothing where there is one level.
  QString showLevels(vtkPVIsosurfaceInformation* statistics);
  void showPasses(vtkPVIsosurfaceInformation* statistics);

  vtkWeakPointer<vtkSMProgressiveIsosurfaceRepresentationProxy> Source;
  QLabel* Summary;
  QWidget* Details;
  QProgressBar* Completed;
  QProgressBar* Memory;
  QLabel* Image;
  QLabel* LevelsTitle;
  QLabel* Levels;
  QLabel* UncertainTitle;
  QLabel* Uncertain;
  QTableWidget* Passes;

  Q_DISABLE_COPY(pqIsosurfaceStatisticsWidget)
};

#endif
