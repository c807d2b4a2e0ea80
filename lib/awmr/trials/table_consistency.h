/// Checks tables of runs against the vehicle before anything is fitted: forces beyond its limits,
/// steering angles in another unit. Private to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/trials/read_trials.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// All tables of one vehicle: each is checked with the information of the others too.
struct Tables {
  const Vehicle& vehicle;
  const std::optional<TrialSet<SurgeRow>>& surge;  ///< gives the speed that the vehicle can reach
  /// gives the unit of the forces, together with surge
  const std::optional<TrialSet<TurningRow>>& turning;
};

/// Faults: a tau_speed above 4 F'max, a wheel_force or a side's force above F'max, with the likely
/// units (force_units.h; one unit for all tables); steering angles all below 2 % of the stop, as in
/// radians; speeds and times in other units (table_units.h); turns faster than wheels can roll
/// (turn_evidence.h). Each names the first such row and the mapping that would correct it. With
/// `options.as_is` they are findings (`table-contradiction`, a warning) instead.
void check_consistency(const TrialSet<SurgeRow>& surge, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
void check_consistency(const TrialSet<TurningRow>& turning, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
/// Also adds the warning `coast-beyond-surge`: the coast-downs begin far above the speed of every
/// run.
void check_consistency(const CoastdownSet& coastdown, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);

/// The warning `coast-below-surge`: all coast-downs begin far below the speed of the fastest run,
/// although a vehicle is driven fast to let it coast.
void warn_of_slow_coasts(const TrialData& data, std::vector<Finding>& findings);

}  // namespace awmr
