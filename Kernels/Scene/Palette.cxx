// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Palette.h"

#include "vtkColorTransferFunction.h"
#include "vtkCompressedVolume.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkLookupTable.h"
#include "vtkMath.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVariant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <queue>
#include <set>
#include <vector>

namespace
{
using Color = std::array<double, 4>; // with opacity

constexpr double Visible = 1.0 / 1024.0; // difference of colours
// Nodes of a table nearer to each other, as shares of its range, are one at which it jumps.
constexpr double JumpWidth = 4e-6;
constexpr double ToSide = 1e-6; // of a jump

double DifferenceOf(const Color& a, const Color& b)
{
  double most = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    most = std::max(most, std::abs(a[i] - b[i]));
  }
  return most;
}

Color ColorOf(vtkScalarsToColors* table, double value)
{
  Color color;
  table->GetColor(value, color.data());
  color[3] = table->IsOpaque() || vtkMath::IsNan(value) ? 1.0 : table->GetOpacity(value);
  return color;
}

Color ColorOfNone(vtkScalarsToColors* table)
{
  Color color = ColorOf(table, vtkMath::Nan());
  auto* function = vtkColorTransferFunction::SafeDownCast(table);
  auto* lookup = vtkLookupTable::SafeDownCast(table);
  if (!table->IsOpaque() && (function || lookup))
  {
    color[3] = function ? function->GetNanOpacity() : lookup->GetNanColor()[3];
  }
  return color;
}

// The range of a table, and shares of it, which a logarithmic one counts in decades.
struct TableRange
{
  explicit TableRange(vtkScalarsToColors* table)
    : Low(table->GetRange()[0])
    , High(table->GetRange()[1])
    , Logarithmic(table->UsingLogScale() != 0 && Low > 0.0 && High > Low)
  {
  }

  double ValueAt(double share) const
  {
    return this->Logarithmic ? this->Low * std::pow(this->High / this->Low, share)
                             : this->Low + share * (this->High - this->Low);
  }

  double ShareOf(double value) const
  {
    return this->Logarithmic ? std::log(value / this->Low) / std::log(this->High / this->Low)
                             : (value - this->Low) / (this->High - this->Low);
  }

  double Below() const { return this->Logarithmic ? this->Low / 10.0 : this->Low - this->Extent(); }
  double Above() const
  {
    return this->Logarithmic ? this->High * 10.0 : this->High + this->Extent();
  }

  double Low, High;
  bool Logarithmic;

private:
  double Extent() const { return std::max(this->High - this->Low, 1.0); }
};

// Number of colours of a table that has each for a part of its range; else 0.
int NumberOfSteps(vtkScalarsToColors* table)
{
  if (auto* function = vtkDiscretizableColorTransferFunction::SafeDownCast(table))
  {
    return function->GetDiscretize() ? static_cast<int>(function->GetNumberOfValues()) : 0;
  }
  auto* lookup = vtkLookupTable::SafeDownCast(table);
  return lookup ? static_cast<int>(lookup->GetNumberOfTableValues()) : 0;
}

// Shares of the range at which a table has nodes, or jumps.
std::set<double> FindNodes(vtkScalarsToColors* table, const TableRange& range)
{
  std::set<double> shares;
  const auto add = [&](double value)
  {
    if (value > range.Low && value < range.High)
    {
      shares.insert(range.ShareOf(value));
    }
  };
  const int steps = NumberOfSteps(table);
  for (int i = 1; i < steps; ++i)
  {
    shares.insert(static_cast<double>(i) / steps);
  }
  auto* function = vtkColorTransferFunction::SafeDownCast(table);
  double before = 0.0; // share of the last node
  for (int i = 0; steps == 0 && function && i < function->GetSize(); ++i)
  {
    double node[6]; // value, colour, midpoint to the next and sharpness there
    function->GetNodeValue(i, node);
    add(node[0]);
    const double share = range.ShareOf(std::clamp(node[0], range.Low, range.High));
    if (i > 0)
    {
      double last[6];
      function->GetNodeValue(i - 1, last);
      shares.insert(before + last[4] * (share - before)); // a sharp midpoint is a jump
    }
    before = share;
  }
  auto* opacities = vtkDiscretizableColorTransferFunction::SafeDownCast(table);
  vtkPiecewiseFunction* opacity =
    opacities && !table->IsOpaque() ? opacities->GetScalarOpacityFunction() : nullptr;
  for (int i = 0; opacity && i < opacity->GetSize(); ++i)
  {
    double node[4];
    opacity->GetNodeValue(i, node);
    add(node[0]);
  }
  return shares;
}

// A part of the range without jumps.
struct Part
{
  double From, To; // shares of the range
  Color First, Last;
  Color Middle;
  double Error; // of the middle, if the colours between are interpolated
  bool operator<(const Part& other) const { return this->Error < other.Error; }
};

class PaletteMaker
{
public:
  PaletteMaker(vtkScalarsToColors* table, vtkCompressedVolume* colors)
    : Table(table)
    , Volume(colors)
    , Range(table)
  {
  }

  glsl::Palette Make()
  {
    const double error = this->Volume->GetLargestError() / this->Volume->GetScale();
    this->Palette.Tolerance = static_cast<float>(std::max(error, 0.0));
    Store(ColorOf(this->Table, this->Range.Below()), this->Palette.Below);
    Store(ColorOf(this->Table, this->Range.Above()), this->Palette.Above);
    Store(ColorOfNone(this->Table), this->Palette.None);
    if (this->Table->GetIndexedLookup())
    {
      this->AddCategories();
    }
    else if (this->Range.High > this->Range.Low)
    {
      this->AddParts();
    }
    else
    {
      const Color color = ColorOf(this->Table, this->Range.Low);
      this->AddNode(this->Range.Low, color);
      this->AddNode(this->Range.Low, color);
    }
    return this->Palette;
  }

private:
  static void Store(const Color& color, float (&stored)[4])
  {
    std::transform(
      color.begin(), color.end(), stored, [](double part) { return static_cast<float>(part); });
  }

  void AddNode(double value, const Color& color)
  {
    const int i = this->Palette.NumberOfNodes++;
    float stored[4];
    Store(color, stored);
    std::copy(stored, stored + 3, this->Palette.Nodes[i].Rgb);
    this->Palette.Nodes[i].Value = static_cast<float>(this->Volume->ToStored(value));
    this->Palette.Opacities[i / 4][i % 4] = stored[3];
  }

  // What is not known of compression: any value is the nearest category's.
  void AddCategories()
  {
    std::set<double> values;
    for (vtkIdType i = 0; i < this->Table->GetNumberOfAnnotatedValues(); ++i)
    {
      bool isNumber = false;
      const double value = this->Table->GetAnnotatedValue(i).ToDouble(&isNumber);
      if (isNumber && static_cast<int>(values.size()) < glsl::PALETTE_SIZE)
      {
        values.insert(value);
      }
    }
    for (const double value : values)
    {
      this->AddNode(value, ColorOf(this->Table, value));
    }
    const double most = values.empty() ? 0.0 : std::max(-*values.begin(), *values.rbegin());
    const double rounding = 1e-6 * std::abs(this->Volume->ToStored(most));
    const bool isKnown = this->Volume->GetLargestError() >= 0.0;
    this->Palette.Tolerance = isKnown
      ? std::max(this->Palette.Tolerance, static_cast<float>(rounding))
      : std::numeric_limits<float>::max();
  }

  Color At(double share) const { return ColorOf(this->Table, this->Range.ValueAt(share)); }

  Part MakePart(double from, double to, const Color& first, const Color& last) const
  {
    const double middle = (from + to) / 2.0;
    const double low = this->Range.ValueAt(from), high = this->Range.ValueAt(to);
    const double weight = (this->Range.ValueAt(middle) - low) / (high - low);
    Part part = { from, to, first, last, this->At(middle), 0.0 };
    Color interpolated;
    for (int i = 0; i < 4; ++i)
    {
      interpolated[i] = first[i] + weight * (last[i] - first[i]);
    }
    part.Error = DifferenceOf(part.Middle, interpolated);
    return part;
  }

  // The parts between nodes; of too many nodes, parts of equal size.
  std::vector<Part> MakeParts() const
  {
    std::vector<double> ends = { 0.0 };
    for (const double share : FindNodes(this->Table, this->Range))
    {
      if (share - ends.back() > JumpWidth && share < 1.0 - JumpWidth)
      {
        ends.push_back(share);
      }
    }
    const bool fits = 2 * static_cast<int>(ends.size()) <= glsl::PALETTE_SIZE;
    if (!fits)
    {
      ends.resize(glsl::PALETTE_SIZE / 2);
      for (std::size_t i = 0; i < ends.size(); ++i)
      {
        ends[i] = static_cast<double>(i) / static_cast<double>(ends.size());
      }
    }
    ends.push_back(1.0);
    std::vector<Part> parts;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    {
      const double side = fits ? ToSide : 0.0;
      parts.push_back(this->MakePart(
        ends[i], ends[i + 1], this->At(ends[i] + side), this->At(ends[i + 1] - side)));
    }
    return parts;
  }

  // Halves those parts that need it most, as long as there is room for nodes.
  std::vector<Part> Refine(const std::vector<Part>& parts) const
  {
    std::priority_queue<Part> queue(parts.begin(), parts.end());
    std::vector<Part> done;
    std::size_t nodes = 2 * parts.size(); // at most
    while (!queue.empty())
    {
      const Part part = queue.top();
      queue.pop();
      const bool isWide = part.To - part.From > 1.0 / 8.0; // the middle alone may mislead
      if (nodes + 1 > glsl::PALETTE_SIZE || !(part.Error > Visible || isWide))
      {
        done.push_back(part);
        continue;
      }
      const double middle = (part.From + part.To) / 2.0;
      queue.push(this->MakePart(part.From, middle, part.First, part.Middle));
      queue.push(this->MakePart(middle, part.To, part.Middle, part.Last));
      ++nodes;
    }
    std::sort(
      done.begin(), done.end(), [](const Part& a, const Part& b) { return a.From < b.From; });
    return done;
  }

  void AddParts()
  {
    const Part* before = nullptr;
    const std::vector<Part> parts = this->Refine(this->MakeParts());
    for (const Part& part : parts)
    {
      if (!before || DifferenceOf(before->Last, part.First) > Visible / 4.0)
      {
        this->AddNode(this->Range.ValueAt(part.From), part.First);
      }
      this->AddNode(this->Range.ValueAt(part.To), part.Last);
      before = &part;
    }
  }

  vtkScalarsToColors* Table;
  vtkCompressedVolume* Volume;
  TableRange Range;
  glsl::Palette Palette = {};
};
}

std::optional<glsl::Palette> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* colors)
{
  if (!colors)
  {
    return std::nullopt;
  }
  table->Build();
  return PaletteMaker(table, colors).Make();
}

bool IsSamePalette(const std::optional<glsl::Palette>& a, const std::optional<glsl::Palette>& b)
{
  return a.has_value() == b.has_value() &&
    (!a || std::memcmp(&a.value(), &b.value(), sizeof(glsl::Palette)) == 0);
}

const std::optional<glsl::Palette>& PaletteCache::Update(
  vtkScalarsToColors* table, vtkCompressedVolume* colors, vtkMTimeType colorsTime)
{
  const vtkMTimeType tableTime = table->GetMTime();
  if (!colors)
  {
    this->Palette = std::nullopt;
  }
  else if (!this->Palette || table != this->Table || tableTime != this->TableTime ||
    colorsTime != this->ColorsTime)
  {
    this->Palette = MakePalette(table, colors);
  }
  this->Table = table;
  this->TableTime = tableTime;
  this->ColorsTime = colorsTime;
  return this->Palette;
}
