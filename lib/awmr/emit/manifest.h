/// Manifest of an emitted directory: lists each file that `awmr emit` wrote, with its hash. So emit
/// can tell its own files from those of the user. A listed file that was edited later belongs to
/// the user and is not replaced. A file that is not listed is replaced only if it begins like a
/// file that emit writes.
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

/// Returns the text of the manifest: the inputs from which the files were made, `figures`, the
/// findings, and every file with its SHA-256. It keeps the entries for other files that the
/// existing manifest in `directory` has. `figures`: empty, or the text of a JSON object whose keys
/// are added to the manifest.
std::string manifest_text(const std::filesystem::path& directory,
                          const std::vector<EmittedFile>& files, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings);

/// Checks that the files may be written to `directory`. An existing file may be replaced if it
/// already has the new content, or if its hash is that in the manifest. A file that the manifest
/// does not list may be replaced if it begins like a header that emit writes. Errors (input): an
/// invalid manifest; each existing file that may not be replaced, or is not a regular file.
Status check_replaceable(const std::filesystem::path& directory,
                         const std::vector<EmittedFile>& files);

/// Returns the files of firmware_library(), but with empty content if the content depends on the
/// model. With these files, check_replaceable() can check a directory before a model exists.
std::vector<EmittedFile> library_outline();

/// The JSON Schema of the manifest.
std::string emit_schema();

}  // namespace awmr
