// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The compressed streams on the GPU, each in as many buffers as it takes.
#ifndef StreamStore_h
#define StreamStore_h

#include "GL/Device.h"
#include "Store/CompressedStream.h"

#include <cstdint>
#include <map>
#include <vector>

class StreamStore
{
public:
  /// Uploads the stream of a level of detail; `buffer` is Stream or ColorStream.
  Status Upload(
    Context& context, Buffer buffer, const CompressedStream& stream, const LevelGrid& grid);
  void Free();

  /// What a stage is dispatched over: the stream that it reads. Empty where it reads none, or the
  /// stream is not on the GPU.
  const std::vector<BoundSegment>& GetSegments(Stage stage) const;
  std::int64_t GetBytes(Buffer buffer) const;

private:
  struct Stream
  {
    std::vector<BoundSegment> Segments;
    std::int64_t Bytes = 0;
  };

  std::map<Buffer, Stream> Streams;
};

#endif
