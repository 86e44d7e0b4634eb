// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVCompressedImageWriter.h"

#include "DistributedPieces.h"
#include "FirstError.h"
#include "GatheredImage.h"
#include "Status.h"

#include "vtkAlgorithmOutput.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkXMLImageDataWriter.h"
#include "vtkZFPWriter.h"
#include "vtksys/SystemTools.hxx"

#include <algorithm>

vtkStandardNewMacro(vtkPVCompressedImageWriter);

namespace
{
//------------------------------------------------------------------------------
// Returns process 0's outcome on all processes. All have to call it.
bool Share(bool succeeded)
{
  int shared = succeeded ? 1 : 0;
  if (DistributedPieces::GetNumberOfProcesses() > 1)
  {
    vtkMultiProcessController::GetGlobalController()->Broadcast(&shared, 1, 0);
  }
  return shared != 0;
}

bool IsFirstProcess()
{
  vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
  return !controller || controller->GetLocalProcessId() == 0;
}
}

//------------------------------------------------------------------------------
vtkPVCompressedImageWriter::vtkPVCompressedImageWriter()
{
  this->Compressor->MagnitudeIsLastOn();
}

//------------------------------------------------------------------------------
vtkPVCompressedImageWriter::~vtkPVCompressedImageWriter()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::SetRate(double rate)
{
  this->Compressor->SetRate(rate);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::SetKeepLabels(bool on)
{
  this->Compressor->SetKeepLabels(on);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::SetTolerance(double tolerance)
{
  this->Compressor->SetTolerance(tolerance);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::SetComponent(int component)
{
  this->Compressor->SetComponent(component);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::SetMaskNonFinite(bool on)
{
  this->Compressor->SetMaskNonFinite(on);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::SetLevels(int levels)
{
  this->Compressor->SetLevels(levels);
}

//------------------------------------------------------------------------------
int vtkPVCompressedImageWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
// Every process asks for its own piece.
vtkTypeBool vtkPVCompressedImageWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
  if (request->Has(Pipeline::REQUEST_UPDATE_EXTENT()) && controller)
  {
    vtkInformation* const input = inputVector[0]->GetInformationObject(0);
    input->Set(Pipeline::UPDATE_PIECE_NUMBER(), controller->GetLocalProcessId());
    input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), controller->GetNumberOfProcesses());
    input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    return 1;
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::WriteData()
{
  Images images = this->FindImages();
  const Status status = this->WriteImages(images);
  if (!status)
  {
    vtkErrorMacro(<< status.GetMessage());
  }
  if (!Share(status.IsOk()) || !status)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
  }
}

//------------------------------------------------------------------------------
// Returns the images that this process has, without empty ones.
vtkPVCompressedImageWriter::Images vtkPVCompressedImageWriter::FindImages()
{
  Images images;
  const auto add = [&](vtkDataObject* object)
  {
    vtkImageData* const image = vtkImageData::SafeDownCast(object);
    if (image && image->GetNumberOfPoints() > 0)
    {
      images.emplace_back(image);
    }
  };
  add(this->GetInput());
  if (auto* const composite = vtkCompositeDataSet::SafeDownCast(this->GetInput()))
  {
    const auto blocks = vtk::TakeSmartPointer(composite->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
    {
      add(blocks->GetCurrentDataObject());
    }
  }
  return images;
}

//------------------------------------------------------------------------------
Status vtkPVCompressedImageWriter::WriteImages(Images& images)
{
  const int processes = DistributedPieces::GetNumberOfProcesses();
  const bool isCompressed = std::any_of(images.begin(), images.end(),
    [](vtkImageData* image) { return vtkCompressedVolume::IsCompressed(image); });
  const bool isAnyCompressed =
    processes > 1 ? DistributedPieces::IsTrueAnywhere(isCompressed) : isCompressed;
  if (isAnyCompressed && (processes > 1 || images.size() > 1))
  {
    const Status status = Status::Error("The input is a compressed volume in pieces: extract from "
                                        "the image that is compressed instead.");
    return IsFirstProcess() ? status : Status();
  }
  if (isAnyCompressed)
  {
    return this->WriteFile(images.front());
  }
  // what is wrong here is told once all processes have sent what they have
  const Status selected = this->SelectArrays(images);
  const Images pieces = GatheredImage::Gather(images);
  if (!selected || !IsFirstProcess())
  {
    return selected;
  }
  return this->CompressPieces(pieces);
}

//------------------------------------------------------------------------------
// Replaces images by such that have only the array to compress, and flags.
Status vtkPVCompressedImageWriter::SelectArrays(Images& images)
{
  vtkInformation* const choice = this->GetInputArrayInformation(0);
  const char* const chosen =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  for (auto& image : images)
  {
    int association = vtkDataObject::POINT;
    vtkDataArray* array = nullptr;
    if (chosen && *chosen)
    {
      association = choice->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::CELL
        ? vtkDataObject::CELL
        : vtkDataObject::POINT;
      array = image->GetAttributes(association)->GetArray(chosen);
    }
    else
    {
      array = vtkImageZFPCompress::FindDefaultArray(image, association);
    }
    if (!array || !array->GetName())
    {
      images.clear();
      return chosen && *chosen
        ? Status::Error("The image has no ", association == vtkDataObject::CELL ? "cell" : "point",
            " array '", chosen, "' to compress.")
        : Status::Error("The image has no array with a name to compress.");
    }
    const auto selected = vtkSmartPointer<vtkImageData>::New();
    selected->CopyStructure(image);
    selected->GetPointData()->Initialize();
    selected->GetCellData()->Initialize();
    selected->GetPointData()->AddArray(image->GetPointGhostArray());
    selected->GetCellData()->AddArray(image->GetCellGhostArray());
    selected->GetAttributes(association)->SetScalars(array);
    image = selected;
  }
  return {};
}

//------------------------------------------------------------------------------
Status vtkPVCompressedImageWriter::CompressPieces(const Images& pieces)
{
  if (pieces.empty())
  {
    return Status::Error(
      "There is no image to compress: extract from image data (vtkImageData), or "
      "resample to it.");
  }
  int association = vtkDataObject::POINT;
  vtkDataArray* const array = vtkImageZFPCompress::FindDefaultArray(pieces.front(), association);
  vtkNew<vtkImageData> whole;
  if (Status status =
        GatheredImage::Assemble(pieces, array ? array->GetName() : "", association, whole);
      !status)
  {
    return status;
  }
  this->Compressor->SetInputData(whole);
  const FirstError errors(this->Compressor);
  this->Compressor->Update();
  this->Compressor->RemoveAllObservers();
  this->Compressor->GetExecutive()->RemoveAllObservers();
  this->Compressor->SetInputData(nullptr);
  if (!errors.GetStatus())
  {
    return errors.GetStatus();
  }
  return this->WriteFile(vtkImageData::SafeDownCast(this->Compressor->GetOutputDataObject(0)));
}

//------------------------------------------------------------------------------
Status vtkPVCompressedImageWriter::WriteFile(vtkImageData* volume)
{
  const std::string name = this->FileName ? this->FileName : "";
  const std::string ending =
    vtksys::SystemTools::LowerCase(vtksys::SystemTools::GetFilenameLastExtension(name));
  const auto writeBy = [&](auto* writer)
  {
    writer->SetInputData(volume);
    writer->SetFileName(name.c_str());
    const FirstError errors(writer);
    const bool isWritten = writer->Write() != 0;
    return !errors.GetStatus() || isWritten
      ? errors.GetStatus()
      : Status::Error("The file '", name, "' could not be written.");
  };
  if (ending == ".zfp")
  {
    return writeBy(vtkNew<vtkZFPWriter>().Get());
  }
  if (ending == ".vti")
  {
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetCompressorTypeToNone(); // the stream is compressed already
    writer->SetHeaderTypeToUInt64();
    return writeBy(writer.Get());
  }
  return Status::Error("A compressed volume is written to a file whose name ends with .vti, or "
                       "with .zfp, not to '",
    name, "'.");
}

//------------------------------------------------------------------------------
void vtkPVCompressedImageWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Compressor:\n";
  this->Compressor->PrintSelf(os, indent.GetNextIndent());
}
