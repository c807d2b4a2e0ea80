/// What contradicts the vehicle in tables of runs, found before anything is fitted: forces beyond its
/// limits, steering angles in another unit. Private to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/trials/read_trials.h"

namespace awmr {

/// Faults: a tau_speed above 4 F'max, a wheel_force or a side's force above F'max, with the likely
/// unit; steering angles that are all below 2 % of the stop, as angles in radians are. Each names
/// the first such row, and the mapping that would mend it; speeds and times in other units
/// (table_units.h). With `options.as_is` they are findings
/// (`table-contradiction`, a warning) instead.
void check_consistency(const TrialSet<SurgeRow>& surge, const std::filesystem::path& path,
                       const Vehicle& vehicle, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
void check_consistency(const TrialSet<TurningRow>& turning, const std::filesystem::path& path,
                       const Vehicle& vehicle, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);

/// `surge`: the same vehicle's runs, which tell how fast it can be.
void check_consistency(const TrialSet<StopTimeRow>& coastdown,
                       const std::optional<TrialSet<SurgeRow>>& surge,
                       const std::filesystem::path& path, const Vehicle& vehicle,
                       const TrialOptions& options, std::vector<Finding>& findings,
                       std::vector<Fault>& faults);

}  // namespace awmr
