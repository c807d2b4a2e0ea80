/// Provenance of an output file: the command, its options and the SHA-256 of its inputs. It has no
/// clock time, so that the same inputs give the same bytes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace awmr {

/// Version of the program, from project() in CMakeLists.txt.
const char* version();

/// An input file of an output. input_file() in input_file.h creates it.
struct InputFile {
  std::string name;    ///< file name without the directory
  std::string sha256;  ///< hash of its bytes
};

/// Names and values of options, in order.
using NamedOptions = std::vector<std::pair<std::string, std::string>>;

/// How an output file was made.
struct Provenance {
  std::string command;  ///< "identify", "tune", ...
  /// Every option, including defaults.
  NamedOptions options;
  std::vector<InputFile> inputs;
};

}  // namespace awmr
