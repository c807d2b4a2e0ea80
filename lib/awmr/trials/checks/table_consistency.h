/// Checks tables of runs for wrong units, before any fit. Private to trials/.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/trials/read_trials.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// The vehicle and its other tables, with which a table is compared.
struct Tables {
  const Vehicle& vehicle;
  /// Surge runs. They determine the top speed and the unit of force.
  const std::optional<TrialSet<SurgeRow>>& surge;
  /// Turning runs, which also determine the unit of force.
  const std::optional<TrialSet<TurningRow>>& turning;
};

/// Checks one table. Adds these faults, each at the first wrong row and with the mapping that would
/// correct it:
///   - a tau_speed above n F'max (n driven wheels), or a wheel force above F'max, with the likely
///     units (force_units.h), which are assumed to be the same in all tables;
///   - steering angles that are all below 2 % of the stop: probably radians;
///   - speeds and times in another unit (table_units.h);
///   - turns that are faster than wheels can roll or than grip allows (wrong_turn()).
/// If `options.as_is` is true, adds them as findings (warning `table-contradiction`) instead.
void check_consistency(const TrialSet<SurgeRow>& surge, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
void check_consistency(const TrialSet<TurningRow>& turning, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);
/// Checks a coast-down file: speeds and times in another unit (table_units.h). Also adds the
/// warning `coast-beyond-surge` if a coast-down begins above 1.5 times the speed of the fastest
/// surge run. The speed of the coast-down may then be in another unit, or the fit must extrapolate
/// the surge resistance.
void check_consistency(const CoastdownSet& coastdown, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults);

/// Adds the warning `coast-below-surge` if all coast-downs begin below a third of the speed of the
/// fastest surge run. The speeds of one table may be in another unit.
void warn_of_slow_coasts(const TrialData& data, std::vector<Finding>& findings);

}  // namespace awmr
