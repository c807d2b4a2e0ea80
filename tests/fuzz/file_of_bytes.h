/// A fuzz target's bytes as a file, for readers that take a path: one file in memory, written anew
/// for every input.
#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "awmr/core/result.h"
#include "fuzz/target.h"

namespace awmr::fuzz {

/// The path of a file of these bytes. It lies in a directory of its own, so that a relative path in
/// the bytes leads nowhere.
inline const std::filesystem::path& file_of_bytes(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path kPath = [] {
    const char* memory = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    std::string directory = std::string(memory) + "/awmr-fuzz-XXXXXX";
    require(::mkdtemp(directory.data()) != nullptr, "a directory for the input is made");
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

/// Whether a reader refused the file; a refusal is bad input that names a fault in words one can read.
template <class T>
bool is_refused(const Result<T>& read) {
  if (read) return false;
  require(!read.error().faults.empty(), "an error names a fault");
  require(read.error().kind == ErrorKind::kInput, "a file is bad input, not a fault");
  require(to_text(read.error()).size() < 100'000, "an error can be read");
  return true;
}

}  // namespace awmr::fuzz
