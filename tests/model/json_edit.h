/// Makes JSON documents with one error each from a valid document.
#pragma once

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "awmr/core/json/json.h"
#include "awmr/core/result.h"
#include "support/scratch_file.h"

namespace awmr::testing {

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

/// Returns the faults with which `read` refuses `text`, as `POINTER: MESSAGE`; empty if it is
/// accepted.
template <class Read>
std::vector<std::string> faults_of(Read read, const std::string& text) {
  const ScratchFile file("file.json", text);
  const auto result = read(file.path());
  std::vector<std::string> faults;
  if (result) return faults;
  EXPECT_EQ(result.error().kind, ErrorKind::kInput);
  for (const Fault& fault : result.error().faults) {
    const std::string prefix = file.path().string() + ":";
    EXPECT_THAT(fault.place, ::testing::StartsWith(prefix)) << fault.message;
    faults.push_back(fault.place.substr(std::min(prefix.size(), fault.place.size())) + ": " +
                     fault.message);
  }
  return faults;
}

/// A change of a JSON document: sets or removes the value at a JSON pointer.
struct Edit {
  std::string pointer;
  Json value;
  bool erase = false;
};

inline std::string edited(const std::string& text, const Edit& edit) {
  Json json = Json::parse(text);
  const Json::json_pointer pointer(edit.pointer);
  if (edit.erase) {
    json[pointer.parent_pointer()].erase(pointer.back());
  } else {
    json[pointer] = edit.value;
  }
  return json.dump(2);
}

}  // namespace awmr::testing
