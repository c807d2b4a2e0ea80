/// Where an output comes from: program version, resolved options, inputs by SHA-256. No clock time,
/// so the same inputs give the same bytes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace awmr {

/// The version of the program, as in CMake's project().
const char* version();

/// A file that an output was made from; input_file() in core/input_file.h makes it.
struct InputFile {
  std::string name;    ///< its file name, without the directory: the same wherever it lies
  std::string sha256;  ///< of its bytes
};

struct Provenance {
  std::string command;  ///< "identify", "tune", ...
  /// Every option with its resolved value.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<InputFile> inputs;
};

}  // namespace awmr
