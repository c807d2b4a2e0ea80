/// What contradicts the vehicle in tables of runs, found before anything is fitted: forces beyond its
/// limits, steering angles in another unit. Private to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/trials/read_trials.h"

namespace awmr {

/// All tables of one vehicle: each is judged by what the others tell as well.
struct Tables {
  const Vehicle& vehicle;
  const std::optional<TrialSet<SurgeRow>>& surge;      ///< tells how fast the vehicle can be
  const std::optional<TrialSet<TurningRow>>& turning;  ///< tells the unit of the forces, with surge
};

/// Faults: a tau_speed above 4 F'max, a wheel_force or a side's force above F'max, with the likely units
/// (force_units.h; one unit for all tables); steering angles that are all below 2 % of the stop, as angles
/// in radians are; speeds and times in other units (table_units.h); turns faster than wheels can roll
/// (turn_evidence.h). Each names the first such row, and the mapping that would mend it. With
/// `options.as_is` they are findings (`table-contradiction`, a warning) instead.
void check_consistency(const TrialSet<SurgeRow>& surge, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
void check_consistency(const TrialSet<TurningRow>& turning, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
/// Also `coast-beyond-surge` (a warning): the coast-downs begin at a speed far above that of every run.
void check_consistency(const CoastdownSet& coastdown, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);

}  // namespace awmr
