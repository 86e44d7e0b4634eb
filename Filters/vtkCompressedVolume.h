// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCompressedVolume
 * @brief   the metadata and the stream of a ZFP-compressed vtkImageData
 *
 * A compressed volume is a vtkImageData with the geometry of the original (extent, spacing, origin,
 * direction matrix), without the compressed array, and with these arrays in its field data. They
 * are version 3 of the format. Version 2 had no checksums, version 1 also nothing hidden and no
 * custom units; both are still read.
 *
 * - ProgIso.ZFP.Version (int): 1, 2 or 3
 * - ProgIso.ZFP.Stream (unsigned char): fixed-rate zfp stream, see below
 * - ProgIso.ZFP.BlockBits (int): bits per block of 4x4x4 samples, 9..2048
 * - ProgIso.ZFP.Dimensions (3 64-bit integers): samples per axis (points, or cells for cell data)
 * - ProgIso.ZFP.Range (2 doubles): smallest and largest sample before encoding, as float32
 * - ProgIso.ZFP.ScalarType (int): VTK type of the original array
 * - ProgIso.ZFP.ArrayName (string): name of the original array
 * - ProgIso.ZFP.Component (int): component of the original array, or -1: its magnitude
 * - ProgIso.ZFP.Association (int): 0 point data, 1 cell data
 * - ProgIso.ZFP.Extent (6 integers, optional): the image extent that the stream covers
 * - ProgIso.ZFP.Grid (15 doubles, optional): spacing, origin and direction matrix (row by row) of
 *   the image that has this extent
 * - ProgIso.ZFP.HiddenSamples, ProgIso.ZFP.HiddenCells (pairs of unsigned 64-bit integers,
 *   optional): what is hidden, as runs of blocks (first block, bits), see vtkBlockMask
 * - ProgIso.ZFP.Offset, ProgIso.ZFP.Scale (double, optional, default 0 and 1): the units of the
 *   stream; a sample is Offset + Scale * (value in the stream), in double precision
 * - ProgIso.ZFP.Error (2 doubles, optional): largest and mean error that encoding left
 * - ProgIso.ZFP.MacrocellErrors (triples of floats, optional): smallest and largest sample, and
 *   largest error, of every macrocell of 16x16x16 samples, x fastest, in the stream's units
 * - ProgIso.ZFP.Ranges (unsigned 64-bit integers), ProgIso.ZFP.RangesDirectory (four unsigned
 *   32-bit integers for each page of 64x64x64 samples), optional: the range of values of every
 *   block, see vtkBlockRanges
 * - ProgIso.ZFP.RangesOf (unsigned 32-bit integer): the CRC-32, as that of the metadata, of
 *   BlockBits, Dimensions, HiddenCells, HiddenSamples and PageChecksums, as far as they are there:
 *   of the stream that these ranges belong to. They are not used with another, such as an older
 *   version, which does not know them, may have put in its place.
 * - ProgIso.ZFP.PageChecksums (unsigned 32-bit integers): zlib's CRC-32 of every page of 65536
 * bytes of the stream, the last of which may be shorter; a part of a volume is checked by the pages
 * that hold its blocks
 * - ProgIso.ZFP.MetadataChecksum (unsigned 32-bit integer): the CRC-32 of all arrays named
 *   ProgIso.ZFP.* but this and the stream, by the bytes of their names: name, 0, number of values
 *   as text, 0, values as 64-bit integers or doubles (little-endian), or texts with 0
 *
 * Levels of detail, coarser copies of the volume, lie in arrays of their own, which readers may
 * leave alone. Level 1 is made of the volume, level 2 of level 1, and so on; each has every second
 * sample along some axes (HalvingFilter.h: sample j lies on sample 2j of the level before), its
 * own stream of its own rate, and the units of the volume's.
 *
 * - ProgIso.Levels (2 64-bit integers): their number, and the CRC-32 of the volume's PageChecksums,
 *   so that levels of another stream are found out
 * - ProgIso.Level<k>.Stream, .BlockBits, .Dimensions, .Range, .Error, .HiddenSamples, .HiddenCells,
 *   .PageChecksums, .Ranges, .RangesDirectory, .RangesOf: as above, of the level's own samples;
 * hidden cells are those between samples, of cell data, too
 * - ProgIso.Level<k>.Steps (3 integers): samples of the volume from one of the level to the next
 * - ProgIso.Level<k>.Distance (double): the most that the interpolant of the level can be off a
 *   sample of the original array, where neither it nor a level before it hides anything
 * - ProgIso.Level<k>.Checksum: as MetadataChecksum, of the arrays named ProgIso.Level<k>.*
 *
 * What the image's own ghost arrays (vtkGhostType) hide is hidden, too: filters may have blanked
 * it.
 *
 * Hidden samples have no values: their stored values are undefined. There is no isosurface in a
 * cell of the interpolant that has a hidden corner, or that is itself hidden.
 *
 * The stream covers the image, or a larger extent: that is so for a piece of an image that several
 * processes share, and for a subset cut out of an image. What lies beyond the image is not part of
 * it, but its samples (ghost samples) serve to interpolate and shade at the image's faces. Filters
 * pass field data on, also those that resample the image or move it: by the grid Read() tells
 * whether the image still has samples of the stream, perhaps by other indices, and refuses others.
 * Without Grid or Extent, and if the image has the stream's size, the stream covers the image.
 *
 * The stream is zfp's (codec 5) for a 3-D float32 array, without zfp's header: blocks in x-fastest
 * order, block i at bit i*BlockBits (bits count from the least significant one of 64-bit
 * little-endian words), padded with zero bits to a multiple of 8 bytes. Being ordinary field data
 * it passes through every VTK reader, writer and pipeline.
 *
 * Read() checks everything: presence, types, sizes, 64-bit overflow, the length of the stream and
 * that the range is finite, and the checksums: those of the metadata always, those of the stream
 * when an array is first read, and not again until it is modified (some GB/s on every core). What
 * it accepts can be decoded without reading out of bounds.
 *
 * Source: P. Lindstrom, "Fixed-Rate Compressed Floating-Point Arrays", TVCG 2014; zfp 1.0.1.
 *
 * @sa vtkImageZFPCompress vtkImageZFPDecompress vtkZFPReader vtkZFPWriter
 */
#ifndef vtkCompressedVolume_h
#define vtkCompressedVolume_h

#include "vtkBlockMask.h"
#include "vtkBlockRanges.h"
#include "vtkObject.h"
#include "vtkProgIsoFiltersModule.h" // for export macro
#include "vtkSmartPointer.h"         // for the stream

#include <string> // for the array name and error messages
#include <vector> // for the levels

class vtkDataObject;
class vtkDoubleArray;
class vtkFloatArray;
class vtkImageData;
class vtkInformation;
class vtkUnsignedCharArray;

class VTKPROGISOFILTERS_EXPORT vtkCompressedVolume : public vtkObject
{
public:
  static vtkCompressedVolume* New();
  vtkTypeMacro(vtkCompressedVolume, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum
  {
    FormatVersion = 3,       ///< that Write() writes, and the newest that can be read
    MinimumBlockBits = 9,    ///< 1 bit "not empty" and 8 bits exponent
    MaximumBlockBits = 2048, ///< 32 bits per sample
    PageBytes = 65536,       ///< bytes of the stream with one checksum
    MaximumLevels = 11,      ///< of detail, beside the volume itself
  };

  enum
  {
    PointData = 0,
    CellData = 1
  };

  enum
  {
    Magnitude = -1 ///< in place of a component: the length of the array's vectors
  };

  /**
   * Whether a data object, which may be null, has a compressed stream in its field data. Cheap;
   * does not tell whether the stream is valid (Read() does).
   */
  static bool IsCompressed(vtkDataObject* object);

  /**
   * Returns the bits per block that zfp uses for a rate in bits per sample (without word
   * alignment): 64*rate rounded to the nearest integer, at least 9. 0 for a rate that is not in (0,
   * 32] or NaN.
   */
  static int BlockBitsForRate(double rate);

  /**
   * Returns the number of 4x4x4 blocks of a volume, and the bytes of its stream, padding included;
   * -1 if a dimension is not positive or the result does not fit 63 bits.
   */
  static vtkTypeInt64 NumberOfBlocksFor(const int dims[3]);
  static vtkTypeInt64 StreamBytesFor(const int dims[3], int blockBits);

  /**
   * Whether an algorithm's input is empty because other processes have all pieces of an image,
   * which is no error.
   */
  static bool IsEmptyPiece(vtkInformation* input);

  /**
   * Finds the extent of an image without its ghost cells, which vtkGhostType marks, and which must
   * be layers around the rest. Empty if there are only ghost cells.
   */
  static void GetOwnExtent(vtkImageData* image, int own[6]);

  /**
   * Finds the extent that a stream should cover so that the part `own` of an image of extent
   * `whole` looks the same as in the whole: one more sample on each side, for normals, extended to
   * whole blocks, counted from the first sample of `whole`, so that each decodes to the same values
   * as in a stream of the whole. At most NumberOfGhostLevels beyond `own`, and nothing beyond
   * `whole`.
   */
  static void GetCoveringExtent(
    const int own[6], const int whole[6], int association, int covering[6]);
  enum
  {
    NumberOfGhostLevels = 5
  };

  /**
   * Takes metadata and stream (by reference) from an image. Returns false, and leaves this object
   * empty, if something is missing, inconsistent with the image, truncated or out of range;
   * GetErrorMessage() then says what.
   */
  bool Read(vtkImageData* image);

  /**
   * Stores metadata and stream (by reference) in the field data of an image, in place of what is
   * there. The inverse of Read().
   */
  void Write(vtkImageData* image) const;

  /**
   * Reduces the stream to the blocks of GetCoveringExtent() for a part of the volume, without
   * encoding them again. `own` lies within GetExtent(). Levels of detail are left out then.
   */
  void Crop(const int own[6]);

  /**
   * Removes the arrays that Write() stores from the field data of any object.
   */
  static void Remove(vtkDataObject* object);

  /**
   * Says that the samples lie where the image does now, after a change of its spacing, origin,
   * directions or extent: Read() cannot tell whether its samples moved along, and refuses it. False
   * for an image that has no stream, or only a part of what its stream covers.
   */
  static bool Place(vtkImageData* image);

  /**
   * Gives a stream, such as a reader has read, an array on the same memory whose range is known at
   * once. VTK looks at every byte of a usual array, some 20 ns long, if a program asks for its
   * range, as ParaView does. What this module makes has such an array already. Masks get arrays,
   * too, whose ranges VTK's writers can write. Does nothing to other objects, which may be null.
   */
  static void SpeedUpRanges(vtkDataObject* object);

  /**
   * What is wrong with the image of the last Read(), as the end of the sentence "The input is ...";
   * empty after a successful one.
   */
  std::string GetErrorMessage() const { return this->ErrorMessage; }

  ///@{
  /**
   * Bits per 4x4x4 block, 9..2048; and the same in bits per sample.
   */
  vtkGetMacro(BlockBits, int);
  vtkSetMacro(BlockBits, int);
  double GetRate() const { return this->BlockBits / 64.0; }
  ///@}

  ///@{
  /**
   * Samples per axis of the stream: point dimensions of its extent, or cell dimensions for cell
   * data. At least 2.
   */
  vtkGetVector3Macro(Dimensions, int);
  vtkSetVector3Macro(Dimensions, int);
  ///@}

  ///@{
  /**
   * The image extent that the stream covers. If it is not set, Write() takes that of the image.
   */
  vtkGetVector6Macro(Extent, int);
  vtkSetVector6Macro(Extent, int);
  ///@}

  /**
   * Whether the stream covers exactly an image.
   */
  bool Covers(vtkImageData* image) const;

  ///@{
  /**
   * Blocks per axis (partial blocks at the upper borders count) and in total.
   */
  void GetBlocks(int blocks[3]) const;
  vtkIdType GetNumberOfBlocks() const;
  ///@}

  ///@{
  /**
   * Smallest and largest visible sample of the original array, after conversion to float32; zeros
   * if all are hidden. Decoded samples may lie a little outside (lossy compression).
   * SetStoredRange() takes the range in the stream's units, and clamps what overflows.
   */
  vtkGetVector2Macro(Range, double);
  vtkSetVector2Macro(Range, double);
  void SetStoredRange(double low, double high);
  ///@}

  ///@{
  /**
   * The stream's units: a sample is Offset + Scale * (value in the stream). Other than 0 and 1 only
   * if float32 cannot hold the samples themselves: small differences on a large value, or values
   * beyond the range of float32 or zfp. Scale is above 0.
   */
  vtkGetMacro(Offset, double);
  vtkSetMacro(Offset, double);
  vtkGetMacro(Scale, double);
  vtkSetMacro(Scale, double);
  bool HasUnits() const { return this->Offset != 0.0 || this->Scale != 1.0; }
  double ToSample(double stored) const { return this->Offset + this->Scale * stored; }
  double ToStored(double sample) const { return (sample - this->Offset) / this->Scale; }
  ///@}

  ///@{
  /**
   * Largest and mean error of the visible samples, in their own units: how far a sample of the
   * original array and the decoded one are apart. -1 if they are not known, as of volumes that
   * older versions wrote. The mean has three digits.
   */
  vtkGetMacro(LargestError, double);
  vtkSetMacro(LargestError, double);
  vtkGetMacro(MeanError, double);
  vtkSetMacro(MeanError, double);
  ///@}

  ///@{
  /**
   * Smallest sample, largest sample and largest error of every macrocell of 16x16x16 samples, x
   * fastest, in the stream's units; a macrocell without visible samples has its smallest above its
   * largest. Null if they are not known.
   */
  vtkFloatArray* GetMacrocellErrors() const;
  void SetMacrocellErrors(vtkFloatArray* macrocells);
  ///@}

  /**
   * Says, in one sentence, of which isovalues the compressed volume's surface is probably not that
   * of the original, and what rate would do; empty if of none, or if errors are not known. That is
   * so if in more than half of the macrocells with a part of the surface the smallest or the
   * largest sample is nearer to the isovalue than the error: with labels, masks and plateaus, not
   * where samples vary smoothly.
   */
  std::string DescribeDoubts(vtkDoubleArray* isovalues) const;

  ///@{
  /**
   * VTK type (VTK_SHORT, ...), name and component (or Magnitude) of the original array. The type is
   * that of the samples: magnitudes are VTK_FLOAT or VTK_DOUBLE.
   */
  vtkGetMacro(ScalarType, int);
  vtkSetMacro(ScalarType, int);
  std::string GetArrayName() const { return this->ArrayName; }
  void SetArrayName(const std::string& name);
  vtkGetMacro(Component, int);
  vtkSetMacro(Component, int);
  ///@}

  ///@{
  /**
   * PointData (0) or CellData (1): where the samples lie, on the image's points or in the centres
   * of its cells (half a cell further in index space).
   */
  vtkGetMacro(Association, int);
  vtkSetMacro(Association, int);
  ///@}

  ///@{
  /**
   * The hidden samples, and, for point data, the hidden cells of the image. From both follow the
   * cells between samples that have no surface: those hidden, or with a hidden corner.
   */
  const vtkBlockMask& GetHiddenSamples() const { return this->HiddenSamples; }
  void SetHiddenSamples(const vtkBlockMask& mask);
  const vtkBlockMask& GetHiddenCells() const { return this->HiddenCells; }
  void SetHiddenCells(const vtkBlockMask& mask);
  vtkBlockMask GetCellsWithoutSurface() const;
  bool HidesAny() const { return !this->HiddenSamples.IsEmpty() || !this->HiddenCells.IsEmpty(); }
  ///@}

  ///@{
  /**
   * The ranges of values of the stream's blocks, without what is hidden; empty if they are not
   * known, as of volumes that older versions wrote, and of parts of others. SetRanges() comes after
   * all else: another stream, and other masks, take them away.
   */
  const vtkBlockRanges& GetRanges() const { return this->Ranges; }
  void SetRanges(const vtkBlockRanges& ranges);
  void ClearRanges() { this->SetRanges(vtkBlockRanges()); }
  bool HasRanges() const { return !this->Ranges.IsEmpty(); }
  vtkTypeInt64 GetRangeBytes() const { return this->Ranges.GetBytes(); }
  ///@}

  /**
   * Decodes all blocks of the stream to find the ranges of their values anew. False where there is
   * no memory for them.
   */
  bool FindRanges();

  /**
   * Decodes all blocks of the stream to compare their ranges of values with those that are known.
   * Returns what is wrong as the end of a sentence that begins with "the ranges"; empty if nothing
   * is, or if no ranges are known.
   */
  std::string CheckRanges();

  ///@{
  /**
   * The stream; null before a successful Read(). At least StreamBytesFor() bytes.
   */
  vtkUnsignedCharArray* GetStream() const;
  void SetStream(vtkUnsignedCharArray* stream);
  ///@}

  /**
   * Decodes all blocks of the stream to find the smallest and largest value, hidden ones included.
   * False if one is not finite, as in damaged streams.
   */
  bool FindDecodedRange(double range[2]) const;

  ///@{
  /**
   * Levels of detail from 1 on, each a volume of its own: with dimensions, stream, bits, units,
   * range, errors and masks, of which that of cells is of those between samples. Null if there is
   * no such level. AddLevel() gives the next one the units and the array's name and type of this
   * volume.
   */
  int GetNumberOfLevels() const { return static_cast<int>(this->Levels.size()); }
  vtkCompressedVolume* GetLevel(int level) const;
  void AddLevel(vtkCompressedVolume* volume);
  ///@}

  ///@{
  /**
   * Of a level: samples of the volume from one of its samples to the next, along each axis, powers
   * of 2; and a bound on how far its interpolant is off the samples of the original array, in their
   * own units, where neither it nor a level before hides anything, -1 if it is not known.
   */
  vtkGetVector3Macro(Steps, int);
  vtkSetVector3Macro(Steps, int);
  vtkGetMacro(LargestDistance, double);
  vtkSetMacro(LargestDistance, double);
  ///@}

  ///@{
  /**
   * Whether what Read() has read has checksums, with which it agrees; files of versions before 3
   * have none. Write() always stores them.
   */
  vtkGetMacro(HasChecksums, bool);
  vtkSetMacro(HasChecksums, bool);
  ///@}

protected:
  vtkCompressedVolume();
  ~vtkCompressedVolume() override;

private:
  vtkCompressedVolume(const vtkCompressedVolume&) = delete;
  void operator=(const vtkCompressedVolume&) = delete;

  void Clear();
  void CropErrors(const int first[3], const int count[3]);
  void CopyBlocks(const int first[3], const int count[3], vtkUnsignedCharArray* target) const;

  int BlockBits = 0;
  int Dimensions[3] = { 0, 0, 0 };
  int Extent[6] = { 0, -1, 0, -1, 0, -1 };
  double Range[2] = { 0.0, 0.0 };
  double Offset = 0.0;
  double Scale = 1.0;
  int ScalarType = 0;
  std::string ArrayName;
  int Component = 0;
  int Association = PointData;
  vtkBlockMask HiddenSamples;
  vtkBlockMask HiddenCells;
  double LargestError = -1.0;
  double MeanError = -1.0;
  vtkSmartPointer<vtkFloatArray> MacrocellErrors;
  vtkSmartPointer<vtkUnsignedCharArray> Stream;
  vtkBlockRanges Ranges;
  bool HasChecksums = false;
  int Steps[3] = { 1, 1, 1 };
  double LargestDistance = -1.0;
  std::vector<vtkSmartPointer<vtkCompressedVolume>> Levels;
  std::string ErrorMessage;
};

#endif
