/// Provides a fuzz target's bytes as a file, for readers that take a path: one file in memory,
/// rewritten for every input.
#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "awmr/core/result.h"
#include "fuzz/target.h"

namespace awmr::fuzz {

/// Returns the path of a file with these bytes. The file is alone in its directory, so that
/// relative paths in the bytes name no existing file.
inline const std::filesystem::path& file_of_bytes(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path kPath = [] {
    const char* memory = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    std::string directory = std::string(memory) + "/awmr-fuzz-XXXXXX";
    require(::mkdtemp(directory.data()) != nullptr, "the directory for the input is created");
    static std::string kept = directory;
    (void)std::atexit([] { std::filesystem::remove_all(kept); });
    return std::filesystem::path(directory) / "input";
  }();
  const int file = ::open(kPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  require(
      file >= 0 && ::write(file, data, size) == static_cast<ssize_t>(size) && ::close(file) == 0,
      "the input is written");
  return kPath;
}

/// True if a reader refused the file. If it did, the error must be an input error with readable
/// faults; otherwise this function aborts.
template <class T>
bool is_refused(const Result<T>& read) {
  if (read) return false;
  require(!read.error().faults.empty(), "an error has at least one fault");
  require(read.error().kind == ErrorKind::kInput, "the error is an input error");
  require(to_text(read.error()).size() < 100'000, "the error text is short");
  return true;
}

}  // namespace awmr::fuzz
