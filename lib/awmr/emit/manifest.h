/// Manifest of an emitted directory: lists each file that `awmr emit` wrote, with its hash, so that
/// emit can tell its own files from the user's. A listed file that was edited belongs to the user
/// and is not replaced. A file that is not listed is replaced only if it begins like a file that
/// emit writes.
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
/// findings, every file with its SHA-256, and the entries for other files in the existing manifest
/// of `directory`. `figures`: empty, or the text of a JSON object whose keys are added to the
/// manifest.
std::string manifest_text(const std::filesystem::path& directory,
                          const std::vector<EmittedFile>& files, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings);

/// Checks that the files may be written to `directory`. An existing file may be replaced if it
/// already has the new content, if its hash is that in the manifest, or if it is not in the
/// manifest and begins like a header that emit writes. Errors (input): an invalid manifest; each
/// existing file that may not be replaced, or is not a regular file.
Status check_replaceable(const std::filesystem::path& directory,
                         const std::vector<EmittedFile>& files);

/// Returns the files of firmware_library(); content that depends on the model is empty. With them,
/// check_replaceable() can check a directory before a model exists.
std::vector<EmittedFile> library_outline();

/// The JSON Schema of the manifest.
std::string emit_schema();

}  // namespace awmr
