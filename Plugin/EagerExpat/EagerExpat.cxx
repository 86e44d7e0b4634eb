// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Lets ParaView 5.11 and VTK 9.2 read appended data again, where libexpat is of 2024 or later.
//
// VTK expects to hear of the tag <AppendedData> before it hands over the raw bytes behind it. Since
// a security update, libexpat keeps a tag that came in small pieces to itself until more follows;
// VTK then parses raw bytes as XML ("not well-formed"). That breaks files with appended data, and
// what ParaView's processes send each other for translucent scenes and integrals. VTK 9.3.1 asks
// libexpat for the old ways; preloaded (LD_PRELOAD), this library does so for older VTK.

#include <dlfcn.h>

extern "C"
{
  struct XML_ParserStruct;

  /// Takes the place of libexpat's function: makes a parser that tells of each tag at once.
  XML_ParserStruct* XML_ParserCreate(const char* encoding)
  {
    using Create = XML_ParserStruct* (*)(const char*);
    using SetDeferral = unsigned char (*)(XML_ParserStruct*, unsigned char);
    // By its name, as the caller may be a driver whose libraries are not in the global scope.
    static void* const expat = dlopen("libexpat.so.1", RTLD_LAZY);
    const auto create =
      expat ? reinterpret_cast<Create>(dlsym(expat, "XML_ParserCreate")) : nullptr;
    // Older versions of libexpat lack this function, and need none.
    const auto setDeferral = expat
      ? reinterpret_cast<SetDeferral>(dlsym(expat, "XML_SetReparseDeferralEnabled"))
      : nullptr;
    XML_ParserStruct* parser = create ? create(encoding) : nullptr;
    if (parser && setDeferral)
    {
      setDeferral(parser, 0);
    }
    return parser;
  }
}
