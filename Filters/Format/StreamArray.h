// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   StreamArray
 * @brief   a stream's bytes, whose range is known at once (internal)
 *
 * ParaView asks every array for its ranges, VTK's writers do so too, and VTK looks at each byte for
 * an answer, some 20 ns long. A stream's first bytes nearly always tell: they have all values, from
 * 0 to 255. To everybody else this is a vtkUnsignedCharArray.
 */
#ifndef StreamArray_h
#define StreamArray_h

#include "vtkUnsignedCharArray.h"

class vtkFieldData;

class StreamArray : public vtkUnsignedCharArray
{
public:
  static StreamArray* New();

  /**
   * Puts an array of this class, on the same memory, in the place of an array of bytes of this
   * name, if there is one.
   */
  static void Replace(vtkFieldData* fields, const char* name);

  /**
   * Finds the smallest and the largest byte, and looks at no more bytes than it needs. False if
   * there are none.
   */
  static bool FindRange(const unsigned char* bytes, vtkTypeInt64 count, double range[2]);

protected:
  StreamArray() = default;
  ~StreamArray() override = default;

  vtkObjectBase* NewInstanceInternal() const override { return StreamArray::New(); }

  ///@{
  /**
   * What vtkDataArray's functions for ranges call. Where an array of ghosts hides bytes, which no
   * field data have, and where a caller has made tuples of the bytes, VTK's own code answers.
   */
  bool ComputeScalarRange(double* ranges) override;
  bool ComputeScalarRange(
    double* ranges, const unsigned char* ghosts, unsigned char ghostsToSkip) override;
  bool ComputeFiniteScalarRange(double* ranges) override;
  bool ComputeFiniteScalarRange(
    double* ranges, const unsigned char* ghosts, unsigned char ghostsToSkip) override;
  ///@}

private:
  StreamArray(const StreamArray&) = delete;
  void operator=(const StreamArray&) = delete;
};

#endif
