// Checks of the claims C3, C6, C7 and C13 about the closed heading loop.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/paper_gains.h"
#include "awmr/validate/claims.h"

namespace awmr {
namespace {

const std::vector<double> kDriven_deg{30.0, 45.0};  ///< headings of the experiment     [paper 6]

/// Criterion for "without overshoot": largest overshoot. An overshoot of 0.5 deg is not visible in
/// a printed figure, and is within the settling band (simulate/metrics.h).
constexpr double kNoOvershoot_deg = 0.5;
/// Criterion for "chattering": a command reverses by more than 1 % of its range more than once per
/// second, on average over the run. A discontinuous law reverses up to every second sample: 50
/// times per second at a sample time of 0.01 s.
constexpr double kReversalBand = 0.01;
constexpr double kReversalsPerSecond = 1.0;
constexpr double kDrivenTauSpeed = 1.4;     ///< 35 % of four motors' thrust       [paper 6]
constexpr double kYawRateMax_degps = 20.0;  ///< bound on the yaw rate in C13 [paper 6]

std::string why_heading_converges_or_not(const HeadingSetting& setting, const ModeRuns& runs,
                                         bool reproduced, bool none_over) {
  std::string why =
      reproduced ? "in every mode, the heading error decays as the sliding-mode law prescribes, "
                   "except while an actuator is at its limit"
      : !none_over
          ? "an actuator limit or the lag of the steering servo carries the heading past its "
            "command in the modes with overshoot"
          : "with these actuator limits, the heading law takes longer than the criterion allows";
  const auto settled_s = [&](YawMode mode) {
    return in_mode(runs, mode).metrics.settling_time_s.value_or(setting.hold_s());
  };
  if (settled_s(YawMode::kSteering) > settled_s(YawMode::kDifferential) &&
      settled_s(YawMode::kSteering) > settled_s(YawMode::kCombined)) {
    why +=
        ". Steering is slowest: the largest steering angle and the small thrust at 1 m/s limit its "
        "yaw moment";
  }
  return why;
}

Claim heading_converges(const HeadingSetting& setting, const ModeRuns& runs) {
  const auto fast = [&](const ModeRun& run) {
    const auto settled_s = run.metrics.settling_time_s;
    return settled_s && *settled_s <= setting.allowed_s(run.mode);
  };
  const auto without_overshoot = [](const ModeRun& run) {
    return run.metrics.overshoot_deg.value_or(0.0) <= kNoOvershoot_deg;
  };
  const bool all_fast = all_modes(runs, fast);
  const bool none_over = all_modes(runs, without_overshoot);
  const bool reproduced = all_fast && none_over;
  return {
      .id = "C3",
      .statement =
          "at 1 m/s, the heading follows steps to 30 and then -30 deg fast and without overshoot, "
          "in all modes",
      .reproduced = reproduced,
      .figure = fmt::format("settling time: {}; overshoot: {}",
                            by_mode(runs, "s", &Metrics::settling_time_s),
                            by_mode(runs, "deg", &Metrics::overshoot_deg)),
      .tolerance = fmt::format(
          "fast: the settling time is at most {}. This is the time to turn {} deg at the mode's "
          "largest steady yaw rate, plus 4 (T1 + 2 T2): four time constants of each phase of the "
          "heading law with the paper's gains (C14). The heading is settled when its error stays "
          "within 2 % of the step (at least 0.5 deg). Without overshoot: at most {} deg",
          by_mode(runs, "s", [&](const ModeRun& run) { return setting.allowed_s(run.mode); }),
          kLargestStep_deg, kNoOvershoot_deg),
      .why = why_heading_converges_or_not(setting, runs, reproduced, none_over),
      .modes = verdicts_by_mode(
          runs, [&](const ModeRun& run) { return fast(run) && without_overshoot(run); })};
}

/// True if every mode has the paper's heading gains and no observer.
bool are_the_papers(const ModeGains& gains) {
  const HeadingGains<double>& paper = kPaperGains.heading;
  return std::ranges::all_of(kYawModes, [&](YawMode mode) {
    const auto& [heading, speed, observer] = gains.in(mode);
    return !observer.is_on() && std::abs(heading.lambda - paper.lambda) +
                                        std::abs(heading.mu - paper.mu) +
                                        std::abs(heading.epsilon - paper.epsilon) <
                                    1e-9;
  });
}

/// Checks C6. The sideslip in differential mode depends on the yaw rate, and therefore on the
/// gains. If the checked gains are not the paper's, Claim::figure therefore has the result with the
/// paper's gains as well.
Claim sideslip_smallest(const HeadingSetting& setting, const ModeRuns& runs) {
  const auto in = [&](YawMode mode) { return in_mode(runs, mode).metrics.sideslip_max_deg; };
  const double differential = in(YawMode::kDifferential);
  const bool smallest =
      differential < in(YawMode::kSteering) && differential < in(YawMode::kCombined);
  Claim claim{
      .id = "C6",
      .statement =
          "the sideslip angle (between the vehicle's x axis and its velocity) is smallest in "
          "differential mode",
      .reproduced = smallest,
      .figure = fmt::format("largest sideslip angle: {}; largest yaw rate: {}",
                            by_mode(runs, "deg", &Metrics::sideslip_max_deg),
                            by_mode(runs, "deg/s", &Metrics::yaw_rate_max_degps)),
      .tolerance =
          "the largest sideslip angle in differential mode is below that of both other modes. "
          "Times with a speed of at most 0.05 m/s do not count",
      .why =
          smallest
              ? "with straight wheels, there is no lateral steering force. Only the inertial term "
                "m' r u (normalised mass m', yaw rate r, surge speed u) causes a sway speed"
              : "the sway speed is about (tau_steering/l_f - m' r u)/a_s, with the lateral force "
                "tau_steering/l_f of the steering, the inertial term m' r u (normalised mass m', "
                "yaw rate r, surge speed u) and the sway resistance a_s. Differential mode has no "
                "steering force, but turns so fast that m' r u alone causes more sideslip"};
  if (!are_the_papers(setting.gains)) {
    const HeadingSetting paper{
        {setting.model, setting.plant, kPaperGains, setting.arithmetic, setting.control}};
    claim.figure += "; largest sideslip angle with the paper's gains: " +
                    by_mode(paper.run("C6", kSimulated_deg), "deg", &Metrics::sideslip_max_deg);
  }
  return claim;
}

/// Number of reversals per second of the command that reverses most often: F'L, F'R or d_r.
double reversals_per_second(const Model& model, const ModeRun& run) {
  std::vector<double> left, right, steering;
  for (const RunRow& row : run.run.rows) {
    left.push_back(row.force.left);
    right.push_back(row.force.right);
    steering.push_back(row.steering_command_rad);
  }
  const double force_band =
      kReversalBand * (model.vehicle.wheel_force.hi - model.vehicle.wheel_force.lo);
  const double steering_band = kReversalBand * 2.0 * radians(model.vehicle.steering_max_deg);
  const int most = std::max({reversals(left, force_band), reversals(right, force_band),
                             reversals(steering, steering_band)});
  return most / run.run.rows.back().t_s;
}

Claim no_chattering(const Model& model, const ModeRuns& runs) {
  const auto rate = [&](const ModeRun& run) { return reversals_per_second(model, run); };
  const auto rests = [&](const ModeRun& run) { return rate(run) <= kReversalsPerSecond; };
  const bool quiet = all_modes(runs, rests);
  return {.id = "C7",
          .statement = "the commands do not chatter (reverse rapidly)",
          .reproduced = quiet,
          .figure =
              "reversals of the command that reverses most often (left force F'L, right force F'R "
              "or steering angle d_r): " +
              by_mode(runs, "reversals/s", rate),
          .tolerance = fmt::format(
              "the mean number of reversals of each command in a run is at most {} per second. "
              "Reversals of at most {:.0f} % of the command's range do not count. A chattering "
              "command reverses up to {:.0f} times per second",
              kReversalsPerSecond, 100.0 * kReversalBand, 0.5 / model.vehicle.sample_time_s),
          .why = quiet ? "inside its boundary layer, the sliding-mode law is continuous. The "
                         "commands change after a heading step and then become constant"
                       : "the control loop is too fast for the sample time or the steering servo, "
                         "so the commands reverse without a heading step",
          .modes = verdicts_by_mode(runs, rests)};
}

/// Scenario of C13: headings and constant thrust of the paper's experiment.
Scenario driven_headings(const HeadingSetting& setting) {
  Scenario driven = heading_steps(kDriven_deg, {.hold_s = setting.hold_s(), .name = "C13"});
  driven.speed_mps = 0.0;
  std::get<HeadingSteps>(driven.guidance).tau_speed = kDrivenTauSpeed;
  return driven;
}

Claim yaw_rate_limited(const HeadingSetting& setting) {
  const ModeRuns runs = setting.ClaimSetting::run(driven_headings(setting));
  const auto holds = [](const ModeRun& run) {
    return run.metrics.completed && run.metrics.yaw_rate_max_degps < kYawRateMax_degps;
  };
  const bool everywhere = all_modes(runs, holds);
  const bool in_steering = holds(in_mode(runs, YawMode::kSteering));
  return {
      .id = "C13",
      .statement =
          "with the constant thrust of the experiment (tau_speed = 1.4), the vehicle reaches "
          "headings of 30 and then 45 deg with yaw rates below 20 deg/s",
      .reproduced = everywhere,
      .figure = "largest yaw rate: " + by_mode(runs, "deg/s", &Metrics::yaw_rate_max_degps),
      .tolerance =
          "in every mode, the largest yaw rate is below 20 deg/s and the heading settles after "
          "both steps. The simulation has no sensor noise, unlike the experiment",
      .why =
          everywhere ? "at this thrust, the yaw moments of all modes are so small that the yaw "
                       "resistance g3 keeps the yaw rate below 20 deg/s"
          : in_steering
              ? "in steering mode, the largest steering angle limits the yaw moment and therefore "
                "the yaw rate. In the other two modes, different left and right wheel forces turn "
                "the vehicle faster. According to its conclusion, the paper used combined mode"
              : "in steering mode, the largest yaw rate is 20 deg/s or more in spite of the "
                "limited steering angle, or the heading does not settle after one of the two "
                "steps. The largest yaw rate of this mode shows which is the case",
      .modes = verdicts_by_mode(runs, holds)};
}

}  // namespace

std::vector<Claim> check_heading_claims(const ClaimSetting& claim_setting) {
  const HeadingSetting setting{claim_setting};
  const Model& model = setting.model;
  const ModeRuns runs = setting.run("C3", kSimulated_deg);
  return {heading_converges(setting, runs), check_speed_converges(setting, runs),
          check_speed_held(setting, runs),  sideslip_smallest(setting, runs),
          no_chattering(model, runs),       yaw_rate_limited(setting)};
}

}  // namespace awmr
