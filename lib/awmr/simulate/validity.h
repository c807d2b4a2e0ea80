/// Checks whether a run leaves the range of the trials.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/model/fitted_law.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Warning `tyres-differ`: the scenario's tyres give another yaw resistance than the measured one.
std::optional<Finding> tyres_differ(const Scenario& scenario, const Model& model);

/// Warning `no-interval`: some fitted parameters have no interval, so draws do not vary them.
std::optional<Finding> missing_intervals(const Model& model);

/// Warnings about requests in a scenario that this vehicle cannot meet: a step after the end
/// (`late-step`), a waypoint within an obstacle (`blocked-waypoint`), a speed beyond the motors
/// (`unreachable-speed`).
std::vector<Finding> unattainable_requests(const Scenario& scenario, const Model& model);

/// Warning `unsigned-speed-runs-away`: with an unsigned speed, as from a GPS, the speed law
/// accelerates a vehicle that rolls backward: m' mu_s/eps_s > g1(u)/u at a speed that the vehicle
/// reaches. `file`: that of the gains.
std::optional<Finding> unsigned_speed_finding(const Plant<double>& plant,
                                              const Gains<double>& gains, double force_max,
                                              const std::string& file);

/// Limits the rate of heading commands to `limit_degps`, > 0, by a filter with
/// kShapingBandwidth_radps (control/guidance/heading_shaping.h). A filter in the scenario keeps its
/// bandwidth and the smaller limit. No effect in open loop.
void limit_heading_rate(double limit_degps, Scenario& scenario);
inline constexpr double kShapingBandwidth_radps = 4.0;

/// Rate limit of heading commands as an option: deg/s from 0.1 to 3600, "measured" (highest yaw
/// rate of the turning trials) or "none"; empty: not given.
using HeadingRateChoice = std::string;
inline constexpr Interval kLeadRates_degps{0.1, 3600.0};
inline constexpr const char* kMeasuredRate = "measured";
inline constexpr const char* kNoRate = "none";
/// Key of the choice in the recorded options of an output.
inline constexpr const char* kRateName = "heading_rate_limit";

/// Error text of a choice; empty if it is valid.
std::string fault_of_rate(const HeadingRateChoice& choice);

/// Default of a comparison: the highest measured yaw rate, if known, because the model extrapolates
/// in faster turns.
HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& said, const Model& model);

/// Applies the limit to every scenario. Errors (input): as fault_of_rate(); "measured" without a
/// highest measured yaw rate.
Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios);

/// Warning `not-led` if the option is not given and the model has no highest measured yaw rate, so
/// that the heading rate is not limited.
std::optional<Finding> heading_rate_not_limited(const HeadingRateChoice& said, const Model& model);

/// Warning `beyond-trials` if a turn of `fastest_degps`, >= 0, is clearly faster than
/// `measured_degps` > 0, the highest rate at which yaw resistance was measured. `file`: that of the
/// model.
std::optional<Finding> extrapolation_finding(const std::string& file, double measured_degps,
                                             double fastest_degps, const std::string& where,
                                             bool is_rate_limited);

/// Adds the warning `beyond-trials` if a turn of `fastest_degps`, >= 0, is clearly faster than
/// that, because the model extrapolates there. `where`: name of the run, "C3, combined".
/// `is_rate_limited`: the heading rate was limited to the measured one, so the vehicle turns faster
/// than its commanded heading.
void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        std::vector<Finding>& findings, bool is_rate_limited = false);

/// The same for the fastest of several runs with these `metrics`; `where(run)` gives the name of a
/// run.
template <class Runs, class Where>
std::vector<Finding> extrapolation_in(const Model& model, const Runs& runs, const Where& where,
                                      bool is_rate_limited = false) {
  const auto fastest = std::max_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
    return a.metrics.yaw_rate_max_degps < b.metrics.yaw_rate_max_degps;
  });
  std::vector<Finding> findings;
  if (fastest != runs.end()) {
    note_extrapolation(model, fastest->metrics.yaw_rate_max_degps, where(*fastest), findings,
                       is_rate_limited);
  }
  return findings;
}

}  // namespace awmr
