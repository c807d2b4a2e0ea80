// Checks of the claims C4 and C5 about the speed loop, with constant heading and heading steps.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/validate/claims.h"

namespace awmr {
namespace {

/// Criterion for "without overshoot", "without steady error" and "constant": largest difference of
/// the speed from u_d, as a fraction of u_d. A smaller difference is not visible in a printed
/// figure.
constexpr double kNoSpeedError = 0.01;
/// Criterion for a "slight" drop: largest drop, as a fraction of u_d.
constexpr double kSlightDrop = 0.20;

Interval speed_range(const ModeRun& run, double from_s, double to_s) {
  Interval range{1e300, -1e300};
  for (const RunRow& row : run.run.rows) {
    if (row.t_s < from_s || row.t_s > to_s) continue;
    range.lo = std::min(range.lo, row.state.u_mps);
    range.hi = std::max(range.hi, row.state.u_mps);
  }
  return range;
}

/// `none_over`: no mode overshoots; `no_error`: no mode has an error at the end of the run.
std::string why_it_converges(bool none_over, bool no_error) {
  if (!no_error) {
    return "the force limits, or a turn that is not complete at the end of the run, leave a speed "
           "error";
  }
  if (!none_over) {
    return "while the front wheels move, the lag of the steering servo and the force limits make "
           "the thrust differ from the command";
  }
  return "the speed loop is of first order, and the speed law compensates exactly the resistance "
         "of the simulated vehicle, so the speed does not overshoot. The excess after the heading "
         "step comes from the lag of the steering servo: the wheel forces are computed for the "
         "commanded steering angle, but the actual angle follows later";
}

/// Commanded speed minus the smallest speed after the second heading step, m/s, >= 0.
/// Metrics::speed_drop_mps also includes the time before that step.
double speed_drop(const ModeRun& run, double step_s) {
  return std::max(0.0, kSpeed_mps - speed_range(run, step_s, run.run.rows.back().t_s).lo);
}

/// Text of the speed drop with other force limits than the vehicle's, because the paper prints no
/// limits and the claim depends on them.
std::string speed_drop_elsewhere(const HeadingSetting& setting) {
  std::string text;
  for (const Interval limits : {Interval{-1.0, 1.0}, Interval{0.0, 0.5}}) {
    const Interval own = setting.model.vehicle.wheel_force;
    if (std::abs(limits.lo - own.lo) + std::abs(limits.hi - own.hi) < 1e-12) continue;
    Model other = setting.model;
    other.vehicle.wheel_force = limits;
    // These runs have the same duration as the runs with the vehicle's own limits, so that the
    // speed drops can be compared.
    const ModeRuns runs =
        ClaimSetting{other, setting.plant, setting.gains, setting.arithmetic, setting.control}.run(
            heading_steps(kSimulated_deg,
                          {.hold_s = setting.hold_s(), .speed_mps = kSpeed_mps, .name = "C5"}));
    text += fmt::format("; with F' in [{}, {}]: {}", limits.lo, limits.hi,
                        by_mode(runs, "m/s", [&](const ModeRun& run) {
                          return speed_drop(run, setting.hold_s());
                        }));
  }
  return text;
}

/// True if the left or right force reaches a limit after the second heading step.
bool side_saturates(const ModeRun& run, Interval limits, double step_s) {
  const auto at_limit = [&](double force) { return !(force > limits.lo) || !(force < limits.hi); };
  return std::any_of(run.run.rows.begin(), run.run.rows.end(), [&](const RunRow& row) {
    return row.t_s >= step_s && (at_limit(row.force.left) || at_limit(row.force.right));
  });
}

std::string why_speed_is_held_or_not(bool holds, bool saturates, bool others_drop) {
  std::string why = holds ? "differential: the wheel forces suffice for thrust and turn together"
                    : saturates ? "differential: the left or right wheel force reaches its limit "
                                  "in the turn, so the thrust is below the command"
                                : "differential: the speed loop is too slow for the turn";
  why += others_drop
             ? ". Steering and combined: in the turn, the thrust is below the command"
             : ". Steering and combined: at least one drop is outside the range of the criterion. "
               "The exact allocation keeps the commanded thrust in a turn, and the speed law "
               "compensates the inertial term m' r v (normalised mass m', yaw rate r, sway speed "
               "v). Then only the servo's lag and the force limits cause a drop";
  return why;
}

}  // namespace

/// Evaluates the overshoot of the speed from the start to the second heading step, and the speed
/// error at the end of the run. The excess over u_d after that step is reported, but does not
/// affect the verdict; C5 evaluates the speed drop after the step.
Claim check_speed_converges(const HeadingSetting& setting, const ModeRuns& runs) {
  const double step_s = setting.hold_s();
  const auto excess = [](Interval range) { return std::max(0.0, range.hi - kSpeed_mps); };
  const auto overshoot = [&](const ModeRun& run) { return excess(speed_range(run, 0.0, step_s)); };
  const auto later = [&](const ModeRun& run) {
    return excess(speed_range(run, step_s, run.run.rows.back().t_s));
  };
  const auto error = [](const ModeRun& run) {
    return run.run.rows.back().state.u_mps - kSpeed_mps;
  };
  constexpr double kAccepted_mps = kNoSpeedError * kSpeed_mps;
  const auto is_over = [&](const ModeRun& run) { return overshoot(run) > kAccepted_mps; };
  const auto is_right = [&](const ModeRun& run) { return std::abs(error(run)) <= kAccepted_mps; };
  const bool none_over = all_modes(runs, [&](const ModeRun& run) { return !is_over(run); });
  const bool no_error = all_modes(runs, is_right);
  return {
      .id = "C4",
      .statement =
          "the speed reaches the commanded speed u_d without overshoot and without steady-state "
          "error",
      .reproduced = none_over && no_error,
      .figure = fmt::format("overshoot from rest: {}; error at the end of the run: {}; largest "
                            "excess over u_d after the heading step to -30 deg: {}",
                            by_mode(runs, "m/s", overshoot), by_mode(runs, "m/s", error),
                            by_mode(runs, "m/s", later)),
      .tolerance =
          fmt::format("two errors of the speed are at most {} m/s each: the overshoot over u_d "
                      "while the vehicle accelerates from rest, and the error at the end of the "
                      "run. The excess of the speed over u_d after the heading step does not count",
                      kAccepted_mps),
      .why = why_it_converges(none_over, no_error),
      .modes = verdicts_by_mode(
          runs, [&](const ModeRun& run) { return !is_over(run) && is_right(run); })};
}

Claim check_speed_held(const HeadingSetting& setting, const ModeRuns& runs) {
  const double step_s = setting.hold_s();
  const auto drop = [&](const ModeRun& run) { return speed_drop(run, step_s); };
  const ModeRun& differential = in_mode(runs, YawMode::kDifferential);
  const bool holds = drop(differential) <= kNoSpeedError * kSpeed_mps;
  const auto slight = [&](YawMode mode) {
    const double d = drop(in_mode(runs, mode));
    return d > kNoSpeedError * kSpeed_mps && d <= kSlightDrop * kSpeed_mps;
  };
  const bool others = slight(YawMode::kSteering) && slight(YawMode::kCombined);
  const Interval force = setting.model.vehicle.wheel_force;
  return {
      .id = "C5",
      .statement =
          "after a heading step, the speed stays at u_d in differential mode and drops slightly in "
          "steering and combined mode",
      .reproduced = holds && others,
      .figure = fmt::format("largest speed drop after the heading step to -30 deg, with wheel "
                            "forces F' in [{}, {}]: {}{}",
                            force.lo, force.hi, by_mode(runs, "m/s", drop),
                            speed_drop_elsewhere(setting)),
      .tolerance = fmt::format(
          "with the vehicle's range of F' (the first), the drop is at most {0} m/s in differential "
          "mode. In steering and combined mode, it is above {0} m/s and at most {1} m/s",
          kNoSpeedError * kSpeed_mps, kSlightDrop * kSpeed_mps),
      .why = why_speed_is_held_or_not(holds, side_saturates(differential, force, step_s), others)};
}

}  // namespace awmr
