// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   RangeLayout
 * @brief   a volume's pages of 4x4x4 macrocells of 4x4x4 blocks (internal)
 *
 * Pages and macrocells are in x-fastest order. Those at the upper borders have fewer of what they
 * consist of.
 */
#ifndef RangeLayout_h
#define RangeLayout_h

#include "Codec/BlockGeometry.h"

#include "vtkType.h"

#include <algorithm>

class RangeLayout
{
public:
  static constexpr int Side = 4;    // of a page in macrocells, and of a macrocell in blocks
  static constexpr int Count = 64;  // of macrocells in a page, and of blocks in a macrocell
  static constexpr int Samples = 5; // on each axis, that the cells of a block reach

  struct Page
  {
    vtkTypeInt64 First[3]; ///< its first macrocell
    int Size[3];           ///< macrocells on each axis
    int GetNumber() const { return this->Size[0] * this->Size[1] * this->Size[2]; }
  };

  RangeLayout() = default;
  explicit RangeLayout(const int dims[3])
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Dimensions[axis] = dims[axis];
      this->Blocks[axis] = BlocksAlong<vtkTypeInt64>(dims[axis]);
      this->Macrocells[axis] = PartsOf(this->Blocks[axis]);
      this->Pages[axis] = PartsOf(this->Macrocells[axis]);
    }
  }

  const int* GetDimensions() const { return this->Dimensions; }
  const vtkTypeInt64* GetBlocks() const { return this->Blocks; }
  const vtkTypeInt64* GetMacrocells() const { return this->Macrocells; }
  vtkTypeInt64 GetNumberOfPages() const { return Product(this->Pages); }
  vtkTypeInt64 GetNumberOfMacrocells() const { return Product(this->Macrocells); }

  Page GetPage(vtkTypeInt64 page) const
  {
    const vtkTypeInt64 at[3] = { page % this->Pages[0], page / this->Pages[0] % this->Pages[1],
      page / (this->Pages[0] * this->Pages[1]) };
    Page box;
    for (int axis = 0; axis < 3; ++axis)
    {
      box.First[axis] = Side * at[axis];
      box.Size[axis] = SizeAt(box.First[axis], this->Macrocells[axis]);
    }
    return box;
  }

  /// Counts the macrocells of all pages before one.
  vtkTypeInt64 MacrocellsBefore(const Page& page) const
  {
    return page.First[2] * this->Macrocells[0] * this->Macrocells[1] +
      page.Size[2] * (page.First[1] * this->Macrocells[0] + page.Size[1] * page.First[0]);
  }

  vtkTypeInt64 PageOf(const vtkTypeInt64 macrocell[3]) const
  {
    return macrocell[0] / Side +
      this->Pages[0] * (macrocell[1] / Side + this->Pages[1] * (macrocell[2] / Side));
  }

  /// The number of a macrocell in its page.
  static int PlaceIn(const Page& page, const vtkTypeInt64 macrocell[3])
  {
    int at[3];
    std::transform(macrocell, macrocell + 3, page.First, at,
      [](vtkTypeInt64 place, vtkTypeInt64 first) { return static_cast<int>(place - first); });
    return at[0] + page.Size[0] * (at[1] + page.Size[1] * at[2]);
  }

  /// Whether a block has cells: one that holds only the last samples of an axis has none.
  bool HasCells(const vtkTypeInt64 block[3]) const
  {
    return BlockSide * block[0] + 1 < this->Dimensions[0] &&
      BlockSide * block[1] + 1 < this->Dimensions[1] &&
      BlockSide * block[2] + 1 < this->Dimensions[2];
  }

  /// Finds the block of a macrocell by its number in it.
  static void FindBlock(const vtkTypeInt64 macrocell[3], int number, vtkTypeInt64 block[3])
  {
    block[0] = Side * macrocell[0] + number % Side;
    block[1] = Side * macrocell[1] + number / Side % Side;
    block[2] = Side * macrocell[2] + number / (Side * Side);
  }

  /// Calls visit(number in the macrocell, block) for all of a macrocell's 64, of which some may lie
  /// beyond the volume.
  template <typename Visit>
  static void ForEachBlock(const vtkTypeInt64 macrocell[3], const Visit& visit)
  {
    for (int i = 0; i < Count; ++i)
    {
      vtkTypeInt64 block[3];
      FindBlock(macrocell, i, block);
      visit(i, block);
    }
  }

private:
  static vtkTypeInt64 PartsOf(vtkTypeInt64 length) { return (length + Side - 1) / Side; }
  static int SizeAt(vtkTypeInt64 first, vtkTypeInt64 all)
  {
    return static_cast<int>(std::min<vtkTypeInt64>(Side, all - first));
  }
  static vtkTypeInt64 Product(const vtkTypeInt64 n[3]) { return n[0] * n[1] * n[2]; }

  int Dimensions[3] = { 0, 0, 0 };
  vtkTypeInt64 Blocks[3] = { 0, 0, 0 };
  vtkTypeInt64 Macrocells[3] = { 0, 0, 0 };
  vtkTypeInt64 Pages[3] = { 0, 0, 0 };
};

#endif
