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

/// A warning (`tyres-differ`) of a scenario on tyres that turn otherwise than yaw resistance was
/// measured.
std::optional<Finding> tyres_differ(const Scenario& scenario, const Model& model);

/// A warning (`no-interval`) of a model whose fitted parameters lack an interval: draws from it do
/// not vary them.
std::optional<Finding> missing_intervals(const Model& model);

/// Warnings about parts of a scenario without effect on this vehicle: a step behind the end
/// (`late-step`), a waypoint within an obstacle (`blocked-waypoint`), a speed beyond the motors
/// (`unreachable-speed`).
std::vector<Finding> unattainable_requests(const Scenario& scenario, const Model& model);

/// A warning (`unsigned-speed-runs-away`) where the speed law, fed with the size of the speed alone, as
/// a GPS gives it, pushes a vehicle that rolls backward further back: m' mu_s/eps_s > g1(u)/u at a
/// speed that the vehicle reaches. `file` is that of the gains.
std::optional<Finding> unsigned_speed_finding(const Plant<double>& plant,
                                              const Gains<double>& gains, double force_max,
                                              const std::string& file);

/// Limits the rate of heading commands to `limit_degps`, > 0, by a filter of
/// kShapingBandwidth_radps where the scenario has none (control/guidance/heading_shaping.h); one
/// that it has keeps its bandwidth and the lesser limit. In open loop there is no heading to limit.
void limit_heading_rate(double limit_degps, Scenario& scenario);
inline constexpr double kShapingBandwidth_radps = 4.0;

/// Rate limit of heading commands as an option: deg/s from 0.1 to 3600, "measured" (highest yaw
/// rate of the turning trials) or "none"; empty: not given.
using HeadingRateChoice = std::string;
inline constexpr Interval kLeadRates_degps{0.1, 3600.0};
inline constexpr const char* kMeasuredRate = "measured";
inline constexpr const char* kNoRate = "none";
/// Key of the choice among the options recorded in an output.
inline constexpr const char* kRateName = "heading_rate_limit";

/// Error text of a choice; empty if it is valid.
std::string fault_of_rate(const HeadingRateChoice& choice);

/// Default of a comparison: the highest measured yaw rate, if known. Differences between modes in
/// faster turns are extrapolation.
HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& said, const Model& model);

/// Puts the limit into every scenario. Errors (input): as fault_of_rate(); nothing says how fast was
/// measured.
Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios);

/// A warning (`not-led`) if the option is not given and the model has no highest measured yaw rate,
/// so that the heading rate is not limited.
std::optional<Finding> heading_rate_not_limited(const HeadingRateChoice& said, const Model& model);

/// A warning (`beyond-trials`) where a turn of `fastest_degps`, >= 0, is clearly faster than yaw
/// resistance was measured, `measured_degps` > 0. `file` is the model's.
std::optional<Finding> extrapolation_finding(const std::string& file, double measured_degps,
                                             double fastest_degps, const std::string& where,
                                             bool is_rate_limited);

/// Adds a warning (`beyond-trials`) if a turn of `fastest_degps`, >= 0, is clearly faster than
/// that: the model is extrapolated there. `where` names the run: "C3, combined". `is_rate_limited`:
/// the heading's rate was limited to the measured one, and the vehicle turns faster than its
/// commanded heading.
void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        std::vector<Finding>& findings, bool is_rate_limited = false);

/// The same of the fastest of several runs, which have `metrics`; `where(run)` names one.
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
