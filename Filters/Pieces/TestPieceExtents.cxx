// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/PieceExtents.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <array>

namespace
{
using Extent = std::array<int, 6>;

Extent Covering(const Extent& piece, const Extent& whole, bool cellData)
{
  Extent covering;
  PieceExtents::GetCoveringExtent(piece.data(), whole.data(), cellData, covering.data());
  return covering;
}
}

TEST(PieceExtents, EmptyAndContained)
{
  const int whole[6] = { 0, 9, 0, 9, 0, 9 }, part[6] = { 0, 9, 2, 2, 4, 9 };
  const int beyond[6] = { 0, 9, -1, 2, 4, 9 }, empty[6] = { 0, 9, 3, 2, 4, 9 };
  EXPECT_FALSE(PieceExtents::IsEmpty(part));
  EXPECT_TRUE(PieceExtents::IsEmpty(empty));
  EXPECT_TRUE(PieceExtents::Contains(whole, whole));
  EXPECT_TRUE(PieceExtents::Contains(whole, part));
  EXPECT_FALSE(PieceExtents::Contains(part, whole));
  EXPECT_FALSE(PieceExtents::Contains(whole, beyond));
}

// A sample more on each side, then whole blocks of the whole, which begins at 10.
TEST(PieceExtents, CoversWholeBlocksOfTheWhole)
{
  const Extent whole = { 10, 40, 10, 40, 10, 40 };
  EXPECT_EQ(Covering(whole, whole, false), whole);
  EXPECT_EQ(Covering({ 18, 20, 19, 24, 10, 40 }, whole, false), (Extent{ 14, 21, 18, 25, 10, 40 }));
  EXPECT_EQ(Covering({ 18, 20, 19, 24, 10, 40 }, whole, true), (Extent{ 14, 22, 18, 26, 10, 40 }));
}

TEST(PieceExtents, LeavesOutGhostCells)
{
  vtkNew<vtkImageData> image;
  image->SetExtent(5, 11, 0, 4, -2, 3);
  Extent extent;
  PieceExtents::GetExtentWithoutGhosts(image, extent.data());
  EXPECT_EQ(extent, (Extent{ 5, 11, 0, 4, -2, 3 }));
  int own[6] = { 6, 11, 0, 3, -1, 2 };
  image->GenerateGhostArray(own);
  PieceExtents::GetExtentWithoutGhosts(image, extent.data());
  EXPECT_EQ(extent, (Extent{ 6, 11, 0, 3, -1, 2 }));
}

TEST(PieceExtents, AllGhostCellsAreEmpty)
{
  vtkNew<vtkImageData> image;
  image->SetExtent(0, 3, 0, 3, 0, 3);
  image->AllocateCellGhostArray()->Fill(vtkDataSetAttributes::DUPLICATECELL);
  Extent extent;
  PieceExtents::GetExtentWithoutGhosts(image, extent.data());
  EXPECT_TRUE(PieceExtents::IsEmpty(extent.data()));
}
