/// Files that are compiled into the program.
#pragma once

#include <vector>

#include "awmr/core/files/embedded_file.h"

namespace awmr {

/// Returns the files that `awmr init` writes, from the folder templates/, sorted by path. A line of
/// a file may begin with the mark `@NAME `. Such a line is only for one kind of drive, and is
/// written without the mark. NAME is a drive (model/vehicle.h), or `steered` for all drives with
/// steering.
const std::vector<EmbeddedFile>& project_templates();

/// Returns the files that `awmr init --example` writes: unmodified copies of the configs and
/// datasets in the source tree. Each has the path that it has in the source tree:
/// "configs/paper/project.json".
const std::vector<EmbeddedFile>& example_files();

/// Returns a list whose only file is FINDINGS.md.
const std::vector<EmbeddedFile>& findings_file();

}  // namespace awmr
