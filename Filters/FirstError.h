// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Errors and warnings of VTK's objects, in place of VTK's printing them (internal).
 */
#ifndef FirstError_h
#define FirstError_h

#include "Status.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"

#include <string>

/// Returns what an event tells, whose text is "ERROR: In file, line number\nclass (address):
/// message\n\n", or the same of a warning.
inline std::string MessageOfEvent(const void* eventText)
{
  std::string text = static_cast<const char*>(eventText);
  const std::size_t address = text.find("): ");
  text.erase(0, address == std::string::npos ? 0 : address + 3);
  text.erase(text.find_last_not_of('\n') + 1);
  return text;
}

/// Keeps the first error of a filter, a reader or a writer.
class FirstError
{
public:
  explicit FirstError(vtkAlgorithm* algorithm)
  {
    algorithm->AddObserver(vtkCommand::ErrorEvent, this, &FirstError::OnError);
    // the executive reports a second error, that the algorithm failed
    algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this, &FirstError::OnError);
  }

  Status GetStatus() const { return this->First; }

private:
  void OnError(vtkObject*, unsigned long, void* text)
  {
    if (this->First.IsOk())
    {
      this->First = Status::Error(MessageOfEvent(text));
    }
  }

  Status First;
};

#endif
