/// Share of the runs that settle with given gains, and changes with which more runs settle. Each
/// change is confirmed by simulation. Private to tune/.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// True if the simulation of a run did not fail and the vehicle settled on every commanded heading.
bool has_settled(const ModeScore& run);

/// An observer is used only if it increases the share of settled runs by at least this, or if the
/// runs settle anyway.
inline constexpr double kWorthIt = 0.05;

/// Share of the runs of the setting that settle with these gains, [0, 1].
double settled_share(const ObjectiveSetting& setting, const Gains<double>& gains);

/// True if at least `share` of the runs of the setting settle. To save time, it simulates a few
/// vehicles first, and the other vehicles only if `share` can still be reached.
bool enough_settle(const ObjectiveSetting& setting, const Gains<double>& gains, double share);

/// Share of the runs that settle with noise-free sensors, [0, 1].
double settled_share_without_noise(ObjectiveSetting setting, const Gains<double>& gains);

/// Returns the setting with only one mode and one scenario (all scenarios if `scenario` is empty),
/// and without goals.
ObjectiveSetting runs_in(ObjectiveSetting setting, const std::string& scenario, YawMode mode);

/// Largest factor of with_times_scaled() that is tried. With a larger one, the search for remedies
/// takes longer.
inline constexpr double kMostTime = 4.0;
/// Returns the setting with all times of its scenarios multiplied by `factor`.
ObjectiveSetting with_times_scaled(ObjectiveSetting setting, double factor);

/// Returns the setting with only the nominal vehicle and the first drawn vehicles.
ObjectiveSetting on_few_vehicles(ObjectiveSetting setting);

/// Tries changes of the scenarios. Returns those with which at least `share` of the runs settle:
///   - 2 or 4 times all times of the scenarios
///   - no heading-rate limit, if there is one
std::vector<SettlingChange> scenario_changes(const ObjectiveSetting& setting,
                                             const Gains<double>& gains, double share);

/// Searches changes with which more runs settle. It keeps the gains of each pole placement, which
/// takes up to some seconds, because one tuning tries the same changes in several scenarios and
/// modes.
class SettlingSearch {
 public:
  /// `bounds`: bounds that the user gave.
  explicit SettlingSearch(const ConstraintContext& context, const GainBounds& bounds = {})
      : context_(context), bounds_(bounds) {}

  /// True if in at least one scenario and mode, fewer than kSettledShare of the runs settle with
  /// the given gains, and an observer helps: with the observer and gains by pole placement, half of
  /// the runs that did not settle before do settle, or kSettledShare of all runs settle. To save
  /// time, only a few vehicles are simulated with the observer (on_few_vehicles()).
  bool observer_helps(const ObjectiveSetting& setting, const Gains<double>& gains);

  /// Tries one change of gains or limits at a time. Returns the changes with which at least `share`
  /// of the runs settle:
  ///   - an observer with gains by pole placement, if the gains have no observer. If that does not
  ///     suffice, the limit of the steering rate is relaxed, too
  ///   - gains for one mode only, by pole placement, if several modes are tuned
  ///   - wider bounds, with gains by pole placement outside of the given bounds
  ///   - a relaxed limit (relaxed_limits()), with the given gains or with gains by pole placement.
  ///     Of the tried values of a limit, the strictest that suffices is returned
  std::vector<SettlingChange> changes(const ObjectiveSetting& setting, const Gains<double>& gains,
                                      double share);

 private:
  /// Gains by pole placement that meet the constraints of `changed`, the context after the change,
  /// and are within the bounds, unless `change` is kWiderBounds. `change`: name of the change, the
  /// key of the cache `poles_`.
  const std::vector<Gains<double>>& poles(const std::string& change,
                                          const ConstraintContext& changed,
                                          const ObserverGains<double>& observer = {});
  /// Bandwidth, rad/s, of an observer with which at least `share` of the runs settle, together with
  /// gains by pole placement. Empty if there is none, or if the vehicle has no force left to
  /// compensate a disturbance.
  std::optional<double> settling_bandwidth_radps(const ObjectiveSetting& setting,
                                                 const std::string& change,
                                                 const ConstraintContext& changed, double share);
  std::optional<SettlingChange> an_observer(const ObjectiveSetting& setting,
                                            const Gains<double>& gains, double share);
  std::optional<SettlingChange> one_mode(const ObjectiveSetting& setting, double share);
  std::optional<SettlingChange> wider_bounds(const ObjectiveSetting& setting,
                                             const Gains<double>& gains, double share);
  std::vector<SettlingChange> relaxed(const ObjectiveSetting& setting, const Gains<double>& gains,
                                      double share);

  const ConstraintContext& context_;
  GainBounds bounds_;
  /// Gains from poles(), by the name of the change and the bandwidth of the observer.
  std::map<std::pair<std::string, double>, std::vector<Gains<double>>> poles_;
};

/// Text for messages about `changes`: "Each of these changes lets runs settle (...): ...". `runs`:
/// the noun for the runs, such as "runs". Precondition: `changes` is not empty.
std::string describe(const std::vector<SettlingChange>& changes, std::string_view runs);
/// Text for messages if no change was found. `runs` as in describe().
std::string no_change_settles(std::string_view runs);

}  // namespace awmr
