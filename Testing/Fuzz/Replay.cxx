// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs a fuzz target on the files of a folder, so that any compiler can test the kept corpus.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::cerr << "usage: " << argv[0] << " FOLDER-OR-FILE" << std::endl;
    return EXIT_FAILURE;
  }
  LLVMFuzzerInitialize(&argc, &argv);
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(argv[1]))
  {
    std::copy(std::filesystem::directory_iterator(argv[1]), {}, std::back_inserter(files));
  }
  else
  {
    files.emplace_back(argv[1]);
  }
  std::sort(files.begin(), files.end());
  for (const auto& name : files)
  {
    std::cout << name.filename().string()
              << std::endl; // so that the last name is that of a failure
    std::ifstream file(name, std::ios::binary);
    const std::vector<char> bytes{ std::istreambuf_iterator<char>(file), {} };
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::cout << files.size() << " inputs replayed" << std::endl;
  return files.empty() ? EXIT_FAILURE : EXIT_SUCCESS;
}
