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
/// Columns of a turning table of this vehicle. For a vehicle without steering, force_left and
/// force_right are required.
std::span<const CsvColumn> turning_columns(const Vehicle& vehicle);

/// Returns the options with the mappings of the vehicle file appended, and with `has_steering` and
/// `driven_wheels` of the vehicle. Errors: those of parse_column(); a mapping of a column that no
/// trial has (the message suggests the closest name).
Result<TrialOptions> with_vehicle_columns(TrialOptions options, const Vehicle& vehicle);

/// Checks that every mapping of the options was used by a file. `used`: indices of the mappings
/// that were used. Mappings from the vehicle file may remain unused. Errors: any other unused
/// mapping, with one of these reasons: no file has the name FILE of a mapping `FILE:NAME=...`; no
/// file has the source columns (the message suggests the closest name); no file needs the column
/// NAME.
Status check_mappings(const TrialOptions& options, std::span<const std::size_t> used,
                      std::span<const std::filesystem::path> files);

/// Returns a fault for each mapping that none of the files can use, because its file name or its
/// source columns do not exist. Call it after reading has failed, because a misspelt mapping is a
/// frequent cause. Skips mappings of the vehicle file. Also skips mappings to required columns,
/// whose absence is already an error.
std::vector<Fault> unusable_mappings(const TrialOptions& options,
                                     std::span<const std::filesystem::path> files);

}  // namespace awmr
