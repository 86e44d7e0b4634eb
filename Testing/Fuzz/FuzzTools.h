// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tools of the fuzz targets: values from a fuzzer's bytes, and checks that end the program.
// A target is LLVMFuzzerTestOneInput(), which libFuzzer calls, or Replay.cxx with the kept inputs.
#ifndef FuzzTools_h
#define FuzzTools_h

#include "../Cxx/CompressionTestTools.h"

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <sys/mman.h>
#include <unistd.h>

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fuzz
{
// Ends the program if a check fails, so that the fuzzer keeps the input.
#define CHECK(condition, description)                                                              \
  do                                                                                               \
  {                                                                                                \
    if (!(condition))                                                                              \
    {                                                                                              \
      std::cerr << __FILE__ << ":" << __LINE__ << ": " #condition ": " << description              \
                << std::endl;                                                                      \
      std::abort();                                                                                \
    }                                                                                              \
  } while (false)

//------------------------------------------------------------------------------
// Takes values from bytes; returns zeros after the last byte.
class Bytes
{
public:
  Bytes(const std::uint8_t* data, std::size_t size)
    : Next(data)
    , End(data + size)
  {
  }

  std::size_t Left() const { return static_cast<std::size_t>(this->End - this->Next); }
  const std::uint8_t* Rest() const { return this->Next; }

  template <typename T>
  T Take()
  {
    T value{};
    const std::size_t size = std::min(sizeof(T), this->Left());
    if (size > 0)
    {
      std::memcpy(&value, this->Next, size);
    }
    this->Next += size;
    return value;
  }

  int Byte() { return this->Take<std::uint8_t>(); }
  bool Flag() { return this->Byte() % 2 == 1; }

  // Returns a number in [0, count); count <= 65536.
  int Below(int count)
  {
    return (count <= 256 ? this->Byte() : static_cast<int>(this->Take<std::uint16_t>())) % count;
  }

  // Returns a small number, one at the limits of a type, or any.
  vtkTypeInt64 Integer()
  {
    const vtkTypeInt64 most32 = std::numeric_limits<std::int32_t>::max();
    const vtkTypeInt64 most64 = std::numeric_limits<vtkTypeInt64>::max();
    const vtkTypeInt64 edges[] = { most32, -most32 - 1, most32 / 2, -(most32 / 2), 2 * most32 + 1,
      most64, -most64 - 1, vtkTypeInt64(1) << 60, vtkTypeInt64(1) << 16, -65536 };
    const int choice = this->Byte();
    if (choice < 160)
    {
      return choice % 40 - 4;
    }
    if (choice < 240)
    {
      // next to a limit; unsigned, because it may wrap
      return static_cast<vtkTypeInt64>(static_cast<vtkTypeUInt64>(edges[choice % 10]) +
        static_cast<vtkTypeUInt64>(this->Take<std::int8_t>() % 8));
    }
    return this->Take<vtkTypeInt64>();
  }

  // Returns a small number, one at the limits of the type, or any.
  double Number()
  {
    using Limits = std::numeric_limits<double>;
    const double infinity = Limits::infinity();
    const double edges[] = { Limits::quiet_NaN(), infinity, -infinity, 0.0, -0.0, Limits::min(),
      Limits::denorm_min(), Limits::max(), -Limits::max(), 3.4028234663852886e38, 1e39, -1e39,
      1e-45, 1e300, 1e-300, 0.5 };
    const int choice = this->Byte();
    if (choice < 160)
    {
      return (choice - 80) / 4.0;
    }
    return choice < 240 ? edges[choice % 16] : this->Take<double>();
  }

  // Fills memory with the remaining bytes, repeated.
  void Fill(unsigned char* target, std::size_t count)
  {
    std::size_t done = std::min(this->Left(), count);
    if (count > 0)
    {
      done > 0 ? std::memcpy(target, this->Next, done) : std::memset(target, 0, count);
    }
    for (std::size_t more = 0; done > 0 && done < count; done += more)
    {
      more = std::min(done, count - done);
      std::memcpy(target + done, target, more);
    }
  }

private:
  const std::uint8_t* Next;
  const std::uint8_t* End;
};

//------------------------------------------------------------------------------
// A file in memory, with a name to open it.
class File
{
public:
  explicit File(const std::uint8_t* data = nullptr, std::size_t size = 0)
    : Descriptor(memfd_create("fuzz", 0))
    , Name("/proc/self/fd/" + std::to_string(this->Descriptor))
  {
    CHECK(this->Descriptor >= 0, "memfd_create");
    CHECK(write(this->Descriptor, data, size) == static_cast<ssize_t>(size), "write");
  }
  ~File() { close(this->Descriptor); }
  File(const File&) = delete;
  void operator=(const File&) = delete;

  const char* GetName() const { return this->Name.c_str(); }

private:
  int Descriptor;
  std::string Name;
};

//------------------------------------------------------------------------------
// Discards the messages that no observer takes.
class SilentWindow : public vtkOutputWindow
{
public:
  static SilentWindow* New();
  vtkTypeMacro(SilentWindow, vtkOutputWindow);
  void DisplayText(const char*) override {}
};
vtkStandardNewMacro(SilentWindow);

//------------------------------------------------------------------------------
// Updates an algorithm. Returns whether it succeeded; otherwise checks that there is exactly one
// error.
inline bool Update(vtkAlgorithm* algorithm)
{
  const test::Errors errors(algorithm);
  algorithm->Update();
  const bool failed = algorithm->GetErrorCode() != 0;
  CHECK(errors.Texts.size() == (failed ? 1 : 0),
    algorithm->GetClassName() << ": error code " << algorithm->GetErrorCode() << ", "
                              << errors.Describe());
  return !failed;
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  vtkNew<fuzz::SilentWindow> window;
  vtkOutputWindow::SetInstance(window);
  return 0;
}

#endif
