/// Parses JSON text in memory. Limits on its size, far above the size of awmr's own files, protect
/// against hostile files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "awmr/core/json/json.h"

namespace awmr {

inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20U;  ///< size of a file: 64 MiB
inline constexpr std::size_t kMaxJsonDepth = 64;          ///< nesting depth of arrays and objects
inline constexpr std::size_t kMaxJsonValues = 2'000'000;  ///< number of values in a document

/// Parses a text, in time and memory proportional to its length. `file`: name of the text in
/// errors. Errors: a limit is exceeded; a syntax error; a number out of range; a duplicate key.
Result<Json> read_json_text(std::string_view text, const std::string& file);

/// Checks only that a text is JSON, before it is written (a ReadBack, file.h); for files whose keys
/// no command reads. Errors: those of read_json_text().
Status check_json_text(std::string_view text, const std::string& file);

/// Checks a JSON text before it is written (a ReadBack, file.h), with the function
/// `read(JsonObject&)` that later reads the file. Errors: those of read_json_text(); all faults
/// that `read` finds.
template <class Read>
Status check_json_object(std::string_view text, const std::string& file, const Read& read) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_text(text, file));
  AWMR_RETURN_IF_ERROR(read_json_object(document, file, read));
  return {};
}

}  // namespace awmr
