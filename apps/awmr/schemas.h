/// JSON Schemas of all file formats that the program reads and writes.
#pragma once

#include <string>
#include <vector>

namespace awmr::cli {

struct Schema {
  std::string name;       ///< format name: "vehicle"
  std::string (*text)();  ///< JSON Schema, draft 2020-12
};

/// All schemas, in the order in which a user creates the files.
const std::vector<Schema>& schemas();

/// Schema of pil.json, which awmr-pil writes.
std::string pil_schema();

}  // namespace awmr::cli
