// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The array of an input whose isosurfaces are drawn: the one that the user has chosen, or the
// input's default.
#ifndef DrawnArray_h
#define DrawnArray_h

#include <string>

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkImageData;
namespace ImageBlocks
{
struct Found;
}

/// An array of a data set by its association and name; without a name: none.
struct ArrayName
{
  int Association = 0; // vtkDataObject::FIELD_ASSOCIATION_POINTS
  std::string Name;
};

class DrawnArray
{
public:
  /// The mapper's number of vectors' magnitude among their components.
  static constexpr int Magnitude = -1;

  /// Takes the user's choice for plain images; without a name: the default array, as
  /// vtkImageZFPCompress chooses it. Returns whether it is another one than before.
  bool Choose(const ArrayName& array);
  const ArrayName& GetChoice() const { return this->Chosen; }
  /// Takes the component, as ParaView numbers them: as many as there are is the magnitude.
  void ChooseComponent(int component) { this->Component = component; }

  ///@{
  /// Finds the array in an image, plain or compressed, or in blocks of which some have it. Returns
  /// false if nothing can be drawn; `error` says why, if it is not for other processes to draw.
  bool Find(vtkImageData* image, std::string& error);
  bool Find(const ImageBlocks::Found& blocks, std::string& error);
  ///@}
  const ArrayName& Get() const { return this->Found; }

  /// Finds an array of the same association in what is drawn, or in its first block; null: there
  /// is none, or not on this process.
  vtkDataArray* FindBeside(vtkDataObject* drawn, const std::string& name) const;
  /// The mapper's number of the component that is drawn.
  int GetComponent(vtkDataObject* drawn) const;

private:
  ArrayName ChooseIn(vtkDataSet* grid) const;
  bool FindCompressed(vtkImageData* image, std::string& error);
  bool FindPlain(vtkImageData* image, std::string& error);

  ArrayName Chosen;
  ArrayName Found; ///< in the present input
  int Component = 0;
};

#endif
