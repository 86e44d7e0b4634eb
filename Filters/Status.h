// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   Status
 * @brief   whether something worked, and one sentence on why not (internal)
 *
 * Code below the VTK classes returns a Status; only the VTK classes turn an error into
 * vtkErrorMacro. The message may be the end of a sentence whose beginning the caller knows.
 *
 * @code
 * if (Status status = CheckRate(rate); !status)
 * {
 *   vtkErrorMacro(<< status.GetMessage());
 * }
 * @endcode
 */
#ifndef Status_h
#define Status_h

#include <sstream>
#include <string>

class [[nodiscard]] Status
{
public:
  /// Success.
  Status() = default;

  /// An error whose message is all parts, as a stream formats them, one after the other.
  template <typename... Parts>
  static Status Error(const Parts&... parts)
  {
    std::ostringstream message;
    (message << ... << parts);
    Status status;
    status.Failed = true;
    status.Message = message.str();
    return status;
  }

  /// Work that the user stopped: neither success nor an error to show.
  static Status Aborted()
  {
    Status status;
    status.Failed = true;
    return status;
  }

  bool IsOk() const { return !this->Failed; }
  bool IsAborted() const { return this->Failed && this->Message.empty(); }
  explicit operator bool() const { return this->IsOk(); }

  /// Says what went wrong; empty after success, or if the work was stopped.
  const std::string& GetMessage() const { return this->Message; }

  /// Returns an error with text before its message, anything else as it is.
  Status WithPrefix(const std::string& prefix) const
  {
    return this->Message.empty() ? *this : Error(prefix, this->Message);
  }

private:
  bool Failed = false;
  std::string Message;
};

#endif
