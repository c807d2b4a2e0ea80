/// How far a run goes beyond what the trials measured.
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

/// Warnings of what a scenario asks for in vain on this vehicle: a reading that is late by a part
/// of a sample (`rounded-latency`), a step behind the end (`late-step`), a waypoint within an
/// obstacle (`blocked-waypoint`), a speed beyond the motors (`unreachable-speed`).
std::vector<Finding> asked_in_vain(const Scenario& scenario, const Model& model);

/// A warning (`unsigned-speed-runs-away`) where the speed law, fed with the size of the speed alone, as
/// a GPS gives it, pushes a vehicle that rolls backward further back: m' mu_s/eps_s > g1(u)/u at a
/// speed that the vehicle reaches. `file` is that of the gains.
std::optional<Finding> unsigned_speed_finding(const Plant<double>& plant,
                                              const Gains<double>& gains, double force_max,
                                              const std::string& file);

/// Lets the heading that is held or led to turn by at most `limit_degps`, > 0, by a filter of
/// kShapingBandwidth_radps where the scenario has none (control/guidance/heading_shaping.h); one that it has
/// keeps its bandwidth and the lesser limit. In open loop there is no heading to limit.
void limit_heading_rate(double limit_degps, Scenario& scenario);
inline constexpr double kShapingBandwidth_radps = 4.0;

/// How fast headings may be led, as a person says it: deg/s from 0.1 to 3600, "measured", as fast as
/// yaw resistance was, or "none"; empty: not said.
using HeadingRateChoice = std::string;
inline constexpr Interval kLeadRates_degps{0.1, 3600.0};
inline constexpr const char* kMeasuredRate = "measured";
inline constexpr const char* kNoRate = "none";
/// Key of the choice among the options recorded in an output.
inline constexpr const char* kRateName = "heading_rate_limit";

/// What is wrong with a choice; empty: nothing.
std::string fault_of_rate(const HeadingRateChoice& choice);

/// What a comparison does where nothing was said: no faster than was measured, where that is known.
/// What parts the modes in faster turns is the model's extrapolation.
HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& said, const Model& model);

/// Puts the limit into every scenario. Errors (input): as fault_of_rate(); nothing says how fast was
/// measured.
Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios);

/// A warning (`not-led`) where nothing was said and nothing says how fast was measured: the
/// headings are compared as the scenarios have them.
std::optional<Finding> not_led(const HeadingRateChoice& said, const Model& model);

/// A warning (`beyond-trials`) where a turn of `fastest_degps`, >= 0, is clearly faster than yaw
/// resistance was measured, `measured_degps` > 0. `file` is the model's.
std::optional<Finding> extrapolation_finding(const std::string& file, double measured_degps,
                                             double fastest_degps, const std::string& where,
                                             bool is_led);

/// Adds a warning (`beyond-trials`) where a turn of `fastest_degps`, >= 0, is clearly faster than
/// that: what the model says there is extrapolated. `where` names the run: "C3, combined". `is_led`:
/// the heading's rate was limited to what was measured, and the vehicle turns faster than its heading
/// is led.
void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        std::vector<Finding>& findings, bool is_led = false);

/// The same of the fastest of several runs, which have `metrics`; `where(run)` names one.
template <class Runs, class Where>
std::vector<Finding> extrapolation_in(const Model& model, const Runs& runs, const Where& where,
                                      bool is_led = false) {
  const auto fastest = std::max_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
    return a.metrics.yaw_rate_max_degps < b.metrics.yaw_rate_max_degps;
  });
  std::vector<Finding> findings;
  if (fastest != runs.end()) {
    note_extrapolation(model, fastest->metrics.yaw_rate_max_degps, where(*fastest), findings,
                       is_led);
  }
  return findings;
}

}  // namespace awmr
