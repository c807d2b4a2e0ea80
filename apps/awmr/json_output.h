/// Output of `--json`: one JSON object, on stdout for results and on stderr for errors.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr::cli {

inline constexpr const char* kResultSchema = "awmr.result/1";
inline constexpr const char* kErrorSchema = "awmr.error/1";

/// Result of a command for machine use.
struct JsonResult {
  std::string command;
  int exit_code = 0;
  std::vector<std::filesystem::path> written = {};  ///< files written, each as named by the command
  std::vector<Finding> findings = {};
  std::string document = {};  ///< JSON content of the output file; empty: none
};

/// Returns the text of the object `{"schema", "command", "version", "exit_code", "written",
/// "findings", "result"}`. `findings` has the same form as in model.json. `result` is
/// JsonResult::document, or null if the document is empty.
std::string result_text(const JsonResult& result);

/// Returns the text of the object `{"schema", "version", "exit_code", "errors": [{"code", "place",
/// "message"}]}`. Each fault of `error` is an entry of `errors`.
std::string error_text(const Error& error);

// JSON Schemas of the objects of result_text() and error_text().
std::string result_schema();
std::string error_schema();

/// Combines JSON texts into one object. `documents`: pairs of name and text. The name becomes the
/// key; pairs with an empty text are left out.
std::string joined(const std::vector<std::pair<std::string, std::string>>& documents);

/// True if `--json` is among the arguments. The other arguments may be invalid: their errors must
/// then be printed as JSON.
bool requests_json(int argc, char** argv);

}  // namespace awmr::cli
