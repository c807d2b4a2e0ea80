/// Warnings about a simulation: turns faster than the measured ones, requests that the vehicle
/// cannot meet, parameters without an interval. Also limits the rate of heading commands, which
/// keeps turns within the measured range of yaw rates.
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

/// Warning `tyres-differ`: the 3-DOF model and the vehicle on the scenario's tyres turn at yaw
/// rates that differ by more than a factor of 1.5, in simulations with the yaw moment for the
/// highest measured yaw rate. Absent without tyres or without a measured yaw rate.
std::optional<Finding> tyres_differ(const Scenario& scenario, const Model& model);

/// Warning `no-interval`: fitted parameters have neither standard error nor 95 % interval, so the
/// plants drawn from the model do not vary them. Absent if there are no such parameters.
std::optional<Finding> missing_intervals(const Model& model);

/// Warning `imprecise-parameter` for each positive parameter that random plants vary, if its
/// standard error is above kImprecise of its value. With a relative standard error sigma, 5 % of
/// these log-normal draws are wrong by more than a factor of exp(2 sigma). The message names the
/// trial that identifies the parameter.
std::vector<Finding> imprecise_parameters(const Model& model);
/// Limit of the relative standard error; a larger limit warns later.
inline constexpr double kImprecise = 0.5;

/// Warnings about requests that cannot be met: a heading step after the end of the scenario
/// (`late-step`); a waypoint within an obstacle (`blocked-waypoint`); a speed that needs more force
/// than the motors make (`unreachable-speed`).
std::vector<Finding> unattainable_requests(const Scenario& scenario, const Model& model);

/// Warning `unsigned-speed-runs-away`, for a speed sensor without a sign, such as a GPS. If the
/// vehicle rolls backward, the speed law takes this for forward motion and can accelerate it
/// backward, by at most the largest backward force of the wheels, less dead zone and back-EMF. The
/// message has the highest speed at which this happens. Absent if the vehicle cannot reach such a
/// speed backward. `file`: the file of the gains.
std::optional<Finding> unsigned_speed_finding(const Plant<double>& plant, const Vehicle& vehicle,
                                              const ModeGains& gains, const std::string& file);

/// Limits the rate of heading commands to `limit_degps`, > 0, by a filter with the bandwidth
/// kShapingBandwidth_radps, or kShapingSamples/T_s if this is less
/// (control/guidance/heading_shaping.h). A filter of the scenario keeps its bandwidth and a smaller
/// rate limit. No effect in open loop. `sample_time_s`: T_s, > 0.
void limit_heading_rate(double limit_degps, double sample_time_s, Scenario& scenario);
/// Bandwidth of this filter, rad/s. With a larger bandwidth, the reference follows a heading
/// command faster.
inline constexpr double kShapingBandwidth_radps = 4.0;
/// Largest product of this bandwidth and the sample time. With a larger product, the discrete
/// filter overshoots (HeadingShaping::omega_radps), and from about 0.9 on it oscillates.
inline constexpr double kShapingSamples = 0.5;

/// Value of the option --heading-rate-limit. "measured": the highest measured yaw rate of the model
/// (measured_yaw_rate_degps()); "none": no limit; otherwise a number from 0.1 to 3600 in deg/s.
/// Empty: the option is not given.
using HeadingRateChoice = std::string;
inline constexpr Interval kHeadingRateLimits_degps{0.1, 3600.0};
inline constexpr const char* kMeasuredRate = "measured";
inline constexpr const char* kNoRate = "none";
/// Key of the heading rate limit in the options that an output file records.
inline constexpr const char* kRateName = "heading_rate_limit";

/// Returns a message that describes why a choice is invalid; empty if it is valid.
std::string fault_of_rate(const HeadingRateChoice& choice);

/// Returns the heading rate limit for a comparison: the option `choice`, if given. Else "measured"
/// if the model has a highest measured yaw rate, because faster turns extrapolate the yaw
/// resistance; otherwise "none".
HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& choice, const Model& model);

/// Limits the rate of heading commands in every scenario. No effect if the choice is empty or
/// "none". Errors (input): the choice is invalid (fault_of_rate()); or it is "measured", and the
/// model has no highest measured yaw rate.
Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios);

/// Warning `heading-rate-not-limited`: the option --heading-rate-limit is not given (`choice` is
/// empty), and the model has no highest measured yaw rate that could be the limit. Else absent.
std::optional<Finding> heading_rate_not_limited(const HeadingRateChoice& choice,
                                                const Model& model);

/// Turn commands of a scenario, which determine the remedy for turns that are too fast.
struct TurnCommands {
  bool are_headings = true;                   ///< false: open loop
  std::optional<double> rate_max_degps = {};  ///< limit of the heading rate; absent: none
};
TurnCommands turn_commands(const Scenario& scenario);

/// Warning `beyond-trials`: a turn at `fastest_degps`, >= 0, exceeds kLittleFurther times
/// `measured_degps` > 0, the highest rate at which the yaw resistance was measured
/// (measured_yaw_rate_degps()). Else absent, also if there is no such rate. `file`: the file of the
/// model. `where`: name of the run, such as "C3, combined". `commands`: turn commands of the run's
/// scenario. Of several runs, report only the one with the highest yaw rate: a finding for each run
/// would repeat the same advice.
std::optional<Finding> extrapolation_finding(const std::string& file,
                                             const std::optional<double>& measured_degps,
                                             double fastest_degps, const std::string& where,
                                             const TurnCommands& commands);

}  // namespace awmr
