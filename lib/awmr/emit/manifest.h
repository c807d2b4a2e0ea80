/// Manifest of an emitted directory: lists each file that emit wrote, with its hash. A file that is
/// not listed, or was edited since, belongs to the user and is never replaced.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/emit/emit.h"
#include "awmr/model/record.h"

namespace awmr {

inline constexpr const char* kManifest = "awmr_emit.json";

/// Text of the manifest: origin, `figures`, the findings, and every file with its SHA-256. Files in
/// the manifest of `directory` that are not written again stay in it. Precondition: `figures` is
/// empty or a JSON object.
std::string manifest_text(const std::filesystem::path& directory,
                          const std::vector<EmittedFile>& files, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings);

/// Checks that the files may be written to `directory`. An existing file may be replaced if it has
/// the same content, if it matches the manifest, or if the manifest does not list it and it is a
/// header that begins with emit's first line. Errors (input): an invalid manifest; each other file.
Status check_replaceable(const std::filesystem::path& directory,
                         const std::vector<EmittedFile>& files);

/// The files of the whole library as in firmware_library(), for check_replaceable() before a model
/// exists: files that depend on the model are empty.
std::vector<EmittedFile> library_outline();

/// The JSON Schema of the manifest.
std::string emit_schema();

}  // namespace awmr
