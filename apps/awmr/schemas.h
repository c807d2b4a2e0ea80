/// The JSON Schemas of all formats that the program reads and writes.
#pragma once

#include <string>
#include <vector>

namespace awmr::cli {

struct Schema {
  std::string name;       ///< of the format: "vehicle"
  std::string (*text)();  ///< JSON Schema, draft 2020-12
};

/// By the order in which the files are made.
const std::vector<Schema>& schemas();

/// pil.json, which awmr-pil writes.
std::string pil_schema();

}  // namespace awmr::cli
