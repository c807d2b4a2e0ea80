#include "awmr/emit/manifest.h"

#include <algorithm>
#include <limits>
#include <map>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/json/json.h"
#include "awmr/model/findings_json.h"
#include "library_files.h"

namespace awmr {
namespace {

constexpr std::string_view kEmitSchema = "awmr.emit/1";
/// First characters of the headers that emit writes. A file that begins with them may be replaced,
/// even if no manifest lists it.
constexpr std::string_view kMarks[] = {"/* awmr_params.h: ", "/* awmr_autopilot_params.h, "};

/// SHA-256 of each file by its path relative to the emitted directory.
using Hashes = std::map<std::string, std::string>;

Hashes read_manifest(JsonObject& json) {
  json.schema(kEmitSchema);
  read_provenance(json);
  if (auto tables = json.optional_object("tables")) {
    for (JsonObject& table : tables->values()) {
      table.integer("lines", 0, std::numeric_limits<int>::max());
      for (const char* key : {"top_speed", "split", "worst_error", "worst_relative_error"}) {
        table.number(key);
      }
      table.reject_unknown_keys();
    }
  }
  Hashes hashes;
  for (JsonObject& file : json.objects("files")) {
    const std::string path = file.string("path");
    hashes[path] = file.string("sha256");
    file.reject_unknown_keys();
  }
  read_findings(json);
  json.reject_unknown_keys();
  return hashes;
}

/// Reads the hashes in the manifest; empty if there is none. Errors (input): the manifest is
/// invalid.
Result<Hashes> hashes_in(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / kManifest;
  AWMR_ASSIGN_OR_RETURN(const bool exists, regular_file_exists(path));
  if (!exists) return Hashes{};
  return read_json_object(path, read_manifest);
}

/// Returns the reason why `file` must not replace the existing file with the content `bytes`; empty
/// if it may. `written`: hashes of the manifest.
std::string fault_of(const EmittedFile& file, const std::string& bytes, const Hashes& written) {
  if (bytes == file.bytes) return {};
  const auto known = written.find(file.path);
  if (known == written.end()) {
    const bool is_marked = std::ranges::any_of(
        kMarks, [&](std::string_view mark) { return std::string_view(bytes).starts_with(mark); });
    if (is_marked) return {};
    return "is not a file that awmr emit wrote, and emit would replace it. Choose another "
           "directory, or move the file away";
  }
  if (known->second == sha256_hex(bytes)) return {};
  return "was edited since awmr emit wrote it, and emit would replace it. Choose another "
         "directory, "
         "or move the file away";
}

}  // namespace

std::string manifest_text(const std::filesystem::path& directory,
                          const std::vector<EmittedFile>& files, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings) {
  Hashes hashes = hashes_in(directory).value_or(Hashes{});
  for (const EmittedFile& file : files) hashes[file.path] = sha256_hex(file.bytes);
  Json json = output_document(kEmitSchema, provenance);
  if (!figures.empty()) json.update(Json::parse(figures));
  json["files"] = Json::array();
  for (const auto& [path, hash] : hashes) {
    json["files"].push_back({{"path", path}, {"sha256", hash}});
  }
  return with_findings(to_text(json), findings);
}

Status check_replaceable(const std::filesystem::path& directory,
                         const std::vector<EmittedFile>& files) {
  AWMR_ASSIGN_OR_RETURN(const Hashes written, hashes_in(directory));
  std::vector<Fault> faults;
  for (const EmittedFile& file : files) {
    const std::filesystem::path path = directory / file.path;
    const auto exists = regular_file_exists(path);
    if (!exists) {
      append(faults, exists.error().faults);
      continue;
    }
    if (!*exists) continue;
    AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(path));
    std::string fault = fault_of(file, bytes, written);
    if (!fault.empty()) {
      faults.push_back({ErrorCode::kWouldOverwrite, path.string(), std::move(fault)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

std::vector<EmittedFile> library_outline() {
  std::vector<EmittedFile> files;
  for (const char* path :
       {"awmr_params.h", "library.properties", "library.json", "src/awmr_autopilot_params.h"}) {
    files.push_back({path, ""});
  }
  for (const EmbeddedFile& file : embedded_files()) {
    files.push_back({std::string(file.path), std::string(file.bytes)});
  }
  return files;
}

std::string emit_schema() {
  return json_schema_text(kEmitSchema, "Manifest of the files that emit wrote into a directory",
                          [](JsonObject& json) { read_manifest(json); });
}

}  // namespace awmr
