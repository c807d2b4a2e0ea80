/// Warnings about a simulation: turns faster than the measured ones, requests that the vehicle
/// cannot meet, parameters without an interval. Also the limit of the rate of heading commands,
/// which keeps turns within the measured range.
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

/// Warning `tyres-differ`: the yaw rates of the model and of the vehicle on the scenario's tyres
/// differ by more than a factor of 1.5. Both turn with the yaw moment that makes the model turn at
/// the highest measured yaw rate. Absent without tyres or without a measured yaw rate.
std::optional<Finding> tyres_differ(const Scenario& scenario, const Model& model);

/// Warning `no-interval`: some fitted parameters have neither standard error nor 95 % interval, so
/// plants drawn from the model do not vary them. Absent if there are none.
std::optional<Finding> missing_intervals(const Model& model);

/// Warnings about requests that cannot be met: a heading step after the end of the scenario
/// (`late-step`), a waypoint within an obstacle (`blocked-waypoint`), a speed that needs more force
/// than the motors make (`unreachable-speed`).
std::vector<Finding> unattainable_requests(const Scenario& scenario, const Model& model);

/// Warning `unsigned-speed-runs-away`: with a speed sensor without a sign, such as a GPS, the speed
/// law would accelerate a vehicle that rolls backward (runs_away_unsigned()) at a speed that the
/// vehicle can reach. The finding names the highest such speed. `file`: name of the file of the
/// gains. Absent if there is no such speed.
std::optional<Finding> unsigned_speed_finding(const Plant<double>& plant, const Vehicle& vehicle,
                                              const Gains<double>& gains, const std::string& file);

/// Limits the rate of heading commands to `limit_degps`, > 0, by a filter with the bandwidth
/// kShapingBandwidth_radps (control/guidance/heading_shaping.h). If the scenario already has a
/// filter, that filter keeps its bandwidth, and the smaller of its rate limit and `limit_degps` is
/// used. No effect in open loop.
void limit_heading_rate(double limit_degps, Scenario& scenario);
inline constexpr double kShapingBandwidth_radps = 4.0;

/// Value of the option --heading-rate-limit: a number from 0.1 to 3600 in deg/s, "measured" (the
/// highest measured yaw rate, measured_yaw_rate_degps()) or "none". Empty: the option is not given.
using HeadingRateChoice = std::string;
inline constexpr Interval kHeadingRateLimits_degps{0.1, 3600.0};
inline constexpr const char* kMeasuredRate = "measured";
inline constexpr const char* kNoRate = "none";
/// Key of the heading rate limit among the options that an output file records.
inline constexpr const char* kRateName = "heading_rate_limit";

/// The message for an invalid choice; empty if the choice is valid.
std::string fault_of_rate(const HeadingRateChoice& choice);

/// The heading rate limit that a comparison uses: the value of the option, `choice`, if it is
/// given. Default: "measured" if the model has a highest measured yaw rate, because the yaw
/// resistance is extrapolated in faster turns; else "none".
HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& choice, const Model& model);

/// Applies the limit to every scenario; no effect if the choice is empty or "none". Errors (input):
/// the choice is invalid (fault_of_rate()), or is "measured" although the model has no highest
/// measured yaw rate.
Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios);

/// Warning `heading-rate-not-limited`: --heading-rate-limit is not given (`choice` is empty), and
/// the model has no highest measured yaw rate to limit heading commands to. Else absent.
std::optional<Finding> heading_rate_not_limited(const HeadingRateChoice& choice,
                                                const Model& model);

/// How a scenario commands turns. It determines the remedy for turns that are too fast.
struct TurnCommands {
  bool are_headings = true;                   ///< false: open loop
  std::optional<double> rate_max_degps = {};  ///< limit of the heading rate; absent: none
};
TurnCommands turn_commands(const Scenario& scenario);

/// Warning `beyond-trials`: a turn of `fastest_degps`, >= 0, is more than kLittleFurther times as
/// fast as `measured_degps` > 0, the highest rate at which the yaw resistance was measured. Else
/// absent. `file`: the file of the model. For the other parameters, see note_extrapolation().
std::optional<Finding> extrapolation_finding(const std::string& file, double measured_degps,
                                             double fastest_degps, const std::string& where,
                                             const TurnCommands& commands);

/// Adds extrapolation_finding() with the highest measured yaw rate of the model, if there is one.
/// `where`: name of the run, such as "C3, combined". `commands`: those of the run's scenario.
void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        const TurnCommands& commands, std::vector<Finding>& findings);

/// Calls note_extrapolation() for that element of `runs` with the highest yaw rate, and returns the
/// findings. The elements have a member `metrics`. `where(run)` returns the name of a run,
/// `commands(run)` the commands of its scenario.
template <class Runs, class Where, class Commands>
std::vector<Finding> extrapolation_in(const Model& model, const Runs& runs, const Where& where,
                                      const Commands& commands) {
  const auto fastest = std::max_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
    return a.metrics.yaw_rate_max_degps < b.metrics.yaw_rate_max_degps;
  });
  std::vector<Finding> findings;
  if (fastest != runs.end()) {
    note_extrapolation(model, fastest->metrics.yaw_rate_max_degps, where(*fastest),
                       commands(*fastest), findings);
  }
  return findings;
}

}  // namespace awmr
