/// The columns of each kind of trial, and the mappings that give them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// What is read of a file of this kind; see the contract's columns in the README.
std::span<const CsvColumn> columns_of(TrialKind kind);
/// Of a turning table of this vehicle: without steering the sides have a force each.
std::span<const CsvColumn> turning_columns(const Vehicle& vehicle);

/// The options with the vehicle's own mappings behind their own, and without steering where it has
/// none. Errors: as parse_column(); a mapping of a column that no trial has, with the nearest one.
Result<TrialOptions> with_vehicle_columns(TrialOptions options, const Vehicle& vehicle);

/// Errors: a mapping that none of the files used, with the reason: no file is called so, none has
/// the columns that it is made from (with the nearest), or none is asked for its column. `used` are
/// indices into the options' mappings. The vehicle's may be unused.
Status check_mappings(const TrialOptions& options, std::span<const std::size_t> used,
                      std::span<const std::filesystem::path> files);

/// The mappings that none of the files can use, where a file could not be read: a misspelt mapping
/// is often why.
std::vector<Fault> unusable_mappings(const TrialOptions& options,
                                     std::span<const std::filesystem::path> files);

}  // namespace awmr
