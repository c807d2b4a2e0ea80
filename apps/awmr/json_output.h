/// What `--json` prints in place of words: one JSON object, on stdout of what a command found out
/// and did, on stderr of what went wrong.
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

/// What a command leaves for a machine.
struct JsonResult {
  std::string command;
  int exit_code = 0;
  std::vector<std::filesystem::path> written = {};  ///< its files, each as the command names it
  std::vector<Finding> findings = {};
  std::string document = {};  ///< JSON, as in the file that the command writes; empty: none
};

/// `{"schema", "command", "version", "exit_code", "written", "findings", "result"}`; findings as in
/// model.json, `result` is the document or null.
std::string result_text(const JsonResult& result);

/// `{"schema", "version", "exit_code", "errors": [{"place", "message"}]}` of every fault there is.
std::string error_text(const Error& error);

// Their JSON Schemas.
std::string result_schema();
std::string error_schema();

/// One document of several, each under its name; empty ones are left out.
std::string joined(const std::vector<std::pair<std::string, std::string>>& documents);

/// True where `--json` is among the arguments, whatever is wrong with the others.
bool asks_for_json(int argc, char** argv);

}  // namespace awmr::cli
