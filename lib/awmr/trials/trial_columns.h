/// Columns that each kind of trial file can have, and checks of the mappings to them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// Columns read from a file of this kind.
std::span<const CsvColumn> columns_of(TrialKind kind);
/// Columns of a turning table of this vehicle. A vehicle without steering has a force column for
/// each side.
std::span<const CsvColumn> turning_columns(const Vehicle& vehicle);

/// Returns the options with the mappings of the vehicle file appended, and with `has_steering` and
/// `driven_wheels` of the vehicle. Errors: as parse_column(); a mapping of a column that no trial
/// has (the message suggests the closest name).
Result<TrialOptions> with_vehicle_columns(TrialOptions options, const Vehicle& vehicle);

/// Checks that every mapping of the options was used by a file. `used`: indices of the mappings
/// that were used. Mappings from the vehicle file may be unused. Errors: an unused mapping, with
/// the reason: no file has its file name, no file has its source columns (the message suggests the
/// closest name), or no file needs its column.
Status check_mappings(const TrialOptions& options, std::span<const std::size_t> used,
                      std::span<const std::filesystem::path> files);

/// Returns a fault for each mapping that none of the files can use, because no file has its file
/// name or its source columns. For reports of files that could not be read, where a misspelt
/// mapping is a frequent cause. Skips the mappings of the vehicle file, and those of required
/// columns, whose absence is already an error.
std::vector<Fault> unusable_mappings(const TrialOptions& options,
                                     std::span<const std::filesystem::path> files);

}  // namespace awmr
