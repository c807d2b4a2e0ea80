/// Parses JSON documents in memory and defines the size limits of all documents. The limits are far
/// above the program's own files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/json.h"

namespace awmr {

inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxJsonDepth = 64;          ///< nesting depth of arrays and objects
inline constexpr std::size_t kMaxJsonValues = 2'000'000;  ///< in total

/// Parses a text in time and memory proportional to its length; `file` names it in errors. Errors:
/// beyond a limit, syntax, a number out of range (all `FILE:LINE:COLUMN`); duplicate keys.
Result<Json> read_json_text(std::string_view text, const std::string& file);

/// Read-back check (file.h) of a JSON file without a strict reader. Errors: as read_json_text.
Status check_json_text(std::string_view text, const std::string& file);

/// Read-back check with a strict reader: runs `read` on the document. Errors: as read_json_text;
/// all faults that `read` finds.
template <class Read>
Status check_json_object(std::string_view text, const std::string& file, const Read& read) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_text(text, file));
  std::vector<Fault> faults;
  JsonObject json(document, file, "", faults);
  read(json);
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace awmr
