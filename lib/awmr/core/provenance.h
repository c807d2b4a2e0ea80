/// Provenance of an output: program version, resolved options, inputs by SHA-256. No clock time, so
/// that the same inputs give the same bytes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace awmr {

/// The program version, from CMake's project().
const char* version();

/// An input file of an output; input_file() in core/input_file.h creates it.
struct InputFile {
  std::string name;    ///< without the directory, so that the location does not matter
  std::string sha256;  ///< of its bytes
};

struct Provenance {
  std::string command;  ///< "identify", "tune", ...
  /// Every option with its resolved value.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<InputFile> inputs;
};

}  // namespace awmr
