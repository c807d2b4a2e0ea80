/// Columns of each kind of trial, and mappings to them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// Columns read from a file of this kind; the README lists them.
std::span<const CsvColumn> columns_of(TrialKind kind);
/// Columns of a turning table for this vehicle: without steering each side has its own force.
std::span<const CsvColumn> turning_columns(const Vehicle& vehicle);

/// Appends the vehicle's mappings to those of the options, and disables steering if the vehicle has
/// none. Errors: as parse_column(); a mapping of a column that no trial has, with the closest name.
Result<TrialOptions> with_vehicle_columns(TrialOptions options, const Vehicle& vehicle);

/// Errors: a mapping that none of the files used, with the reason: no file has its file name, none
/// has its source columns (with the closest name), or none needs its column. `used` are indices
/// into the options' mappings. The vehicle's mappings may be unused.
Status check_mappings(const TrialOptions& options, std::span<const std::size_t> used,
                      std::span<const std::filesystem::path> files);

/// Mappings that none of the files can use. Reported when a file could not be read, because a
/// misspelt mapping is a frequent cause.
std::vector<Fault> unusable_mappings(const TrialOptions& options,
                                     std::span<const std::filesystem::path> files);

}  // namespace awmr
