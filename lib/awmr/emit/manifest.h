/// The manifest of an emitted directory: each file that emit wrote, with its hash. What is not in it, or
/// was edited since, is the user's and is never replaced.
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

/// The bytes of the manifest: origin, `figures`, the findings, and every file with its SHA-256. Files of
/// the manifest in `directory` that are not written again stay in it. Precondition: `figures` is empty
/// or a JSON object.
std::string manifest_text(const std::filesystem::path& directory,
                          const std::vector<EmittedFile>& files, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings);

/// Errors (input), one for each file in `directory` that would be replaced and is neither the same
/// already, nor as the manifest there has it, nor, where the manifest does not name it, a header that
/// begins with emit's own line; a manifest that is none.
Status check_replaceable(const std::filesystem::path& directory,
                         const std::vector<EmittedFile>& files);

/// The files of the whole library, as firmware_library() has them, for check_replaceable() before there
/// is a model: those that depend on it are empty.
std::vector<EmittedFile> library_outline();

/// The JSON Schema of the manifest.
std::string emit_schema();

}  // namespace awmr
