// Checks of the claims C1, C2 and C14, which need no feedback.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "awmr/control/allocation.h"
#include "awmr/model/paper_gains.h"
#include "awmr/validate/circle_fit.h"
#include "awmr/validate/claims.h"

namespace awmr {
namespace {

constexpr double kCircleTurn_m = 0.4;  ///< the paper's constant tau_turn [paper 3.5.2]

/// Largest accepted relative difference between the final speed and the solution of g1(u) =
/// tau_speed. The error of the integrator and the rest of the transient are far smaller.
constexpr double kSteadyTolerance = 1e-3;
/// Largest accepted relative difference from a measured speed: 5 %, the error of the paper's Table
/// 2 itself, which prints 1.03 m/s for 10 m in 9.26 s (1.080 m/s).
constexpr double kMeasuredTolerance = 0.05;
/// Criterion for "a circle": largest distance of the last full turn from the circle fitted to it,
/// divided by the radius.
constexpr double kCircleTolerance = 0.01;

/// Calls simulate(). If simulate() returns an error, returns a run of one row that ends as kFailed,
/// so that the claim is not reproduced.
Run run_or_failed(const Model& model, const ModeGains& gains, const Scenario& scenario,
                  YawMode mode) {
  Run failed;
  failed.rows.emplace_back();
  failed.end = RunEnd::kFailed;
  return simulate(model, gains.in(mode), scenario, mode).value_or(std::move(failed));
}

Run run_open_loop(const Model& model, YawMode mode, OpenLoop forces, double duration_s,
                  const ControlOptions& control) {
  const Scenario scenario{.name = "open loop",
                          .duration_s = duration_s,
                          .initial = {},
                          .speed_mps = 0.0,
                          .guidance = forces,
                          // As in the paper, the motors have no lag, whatever vehicle.json gives.
                          .actuators = Actuators{},
                          .control = control};
  // Gains have no effect in open loop.
  return run_or_failed(model, kPaperGains, scenario, mode);
}

/// The surge trial at the largest tau_speed; null without surge trials. If its tau_speed is 2 (full
/// thrust), its measured speed is u_max of claim C1.
const TrialPoint* fastest_trial(const Model& model) {
  const TrialPoint* fastest = nullptr;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind == TrialKind::kSurge && (!fastest || trial.input > fastest->input))
      fastest = &trial;
  }
  return fastest;
}

/// Result of C2 in one mode.
struct Turn {
  YawMode mode{};
  /// Circle fitted to the last full turn. Absent if the run has fewer than two full turns.
  std::optional<Circle> circle;
  double speed_mps = 0.0;  ///< speed at the end of the run
};

/// Points of the last full turn of the run. Empty if the run has fewer than two full turns, because
/// the first turn is a transient.
std::vector<Position<double>> last_turn(const Run& run) {
  const double end_rad = run.rows.back().state.psi_rad;
  if (std::abs(end_rad) < 4.0 * std::numbers::pi) return {};
  std::vector<Position<double>> points;
  // Clang 14 does not compile std::views::reverse of GCC 12's library.
  // NOLINTNEXTLINE(modernize-loop-convert)
  for (auto row = run.rows.rbegin(); row != run.rows.rend(); ++row) {
    if (std::abs(end_rad - row->state.psi_rad) > 2.0 * std::numbers::pi) break;
    points.push_back({row->state.x_m, row->state.y_m});
  }
  return points;
}

Turn turn_of(const Model& model, YawMode mode, const ControlOptions& control) {
  Turn turn{.mode = mode, .circle = {}};
  // A slow vehicle needs a longer run for two full turns.
  for (const double duration_s : {60.0, 240.0, 960.0}) {
    const Run run = run_open_loop(model, mode, {kFullThrust, kCircleTurn_m}, duration_s, control);
    const State<double>& end = run.rows.back().state;
    turn.speed_mps = std::hypot(end.u_mps, end.v_mps);
    turn.circle = fit_circle(last_turn(run));
    if (turn.circle) break;
  }
  return turn;
}

std::string figure_of(const Turn& turn) {
  if (!turn.circle)
    return fmt::format("{}: fewer than two full turns in 960 s", name_of(turn.mode));
  return fmt::format(
      "{}: diameter {:.2f} m, deviation from the circle {:.3f} % of its radius, "
      "speed {:.2f} m/s",
      name_of(turn.mode), 2.0 * turn.circle->radius_m,
      100.0 * turn.circle->deviation_m / turn.circle->radius_m, turn.speed_mps);
}

/// Text of the yaw moment that each mode delivers for the commanded tau_turn, which explains the
/// different diameters of the circles.
std::string delivered_moments(const Model& model, const Plant<double>& plant) {
  const AllocationLimits<double> limits = make_controller(plant, model.vehicle, kPaperGains).limits;
  std::string text;
  for (const YawMode mode : kYawModes) {
    const Allocation<double> a = allocate(mode, kFullThrust, kCircleTurn_m, limits);
    const GeneralisedForces<double> tau =
        generalised_forces(plant.front_axle_m, plant.half_track_m, a.force, a.steering_rad);
    text += fmt::format("{}{} {:.3f} m", text.empty() ? "" : ", ", name_of(mode),
                        tau.tau_steering_m + tau.tau_diff_m);
  }
  return text;
}

std::string why_not_settled(const Model& model) {
  return model.vehicle.driven_wheels() * model.vehicle.wheel_force.hi < kFullThrust
             ? "the force limits do not allow tau_speed = 2"
             : "the speed has not settled within 60 s";
}

/// Adds the comparison with the top speed of the fastest trial to the claim C1. `settles`: the
/// simulated speed settles at the solution of g1(u) = 2.
void compare_with_measured(const Model& model, const TrialPoint& fastest, double settled_mps,
                           bool settles, Claim& claim) {
  const double measured_mps = fastest.measured;
  const double difference = settled_mps / measured_mps - 1.0;
  claim.reproduced = settles && std::abs(difference) <= kMeasuredTolerance;
  claim.figure += fmt::format(
      "; the measured u_max is {:.4g} m/s, from which the simulated speed differs by {:+.1f} %",
      measured_mps, 100.0 * difference);
  claim.tolerance += fmt::format(
      ", and from the measured u_max by at most {:.0f} %. The paper's Table 2 itself has an error "
      "of that size",
      100.0 * kMeasuredTolerance);
  claim.why = !settles ? why_not_settled(model)
              : claim.reproduced
                  ? "the speed settles where thrust and resistance are equal. The power law g1 was "
                    "fitted to all trials, so it does not go exactly through the fastest one"
                  : "the fitted power law g1 does not go through the fastest trial";
}

}  // namespace

Claim check_straight_run(const Model& model, const Plant<double>& plant,
                         const ControlOptions& control) {
  Claim claim{.id = "C1",
              .statement =
                  "straight ahead at the paper's full thrust (tau_speed = 2), the speed settles at "
                  "the top speed u_max",
              .figure = {},
              .tolerance = {},
              .why = {}};
  const Run run = run_open_loop(model, YawMode::kDifferential, {kFullThrust, 0.0}, 60.0, control);
  const double settled_mps = run.rows.back().state.u_mps;
  const double steady_mps = std::pow(kFullThrust / plant.surge.alpha, 1.0 / plant.surge.beta);
  const bool settles = std::abs(settled_mps - steady_mps) <= kSteadyTolerance * steady_mps;
  claim.figure =
      fmt::format("simulated {:.4f} m/s; the resistance g1(u) equals the thrust 2 at {:.4f} m/s",
                  settled_mps, steady_mps);
  claim.tolerance =
      fmt::format("the simulated speed differs from the solution of g1(u) = 2 by at most {} %",
                  100.0 * kSteadyTolerance);

  const TrialPoint* fastest = fastest_trial(model);
  const bool at_full_thrust = fastest && std::abs(fastest->input - kFullThrust) < 1e-9;
  if (!at_full_thrust) {
    claim.reproduced = settles;
    claim.why = fmt::format(
        "{}. The model has no surge trial at tau_speed = 2, so there is no measured u_max to "
        "compare with",
        settles ? std::string("the speed settles where thrust and resistance are equal")
                : why_not_settled(model));
    return claim;
  }
  compare_with_measured(model, *fastest, settled_mps, settles, claim);
  return claim;
}

Claim check_circle(const Model& model, const Plant<double>& plant, const ControlOptions& control) {
  Claim claim{.id = "C2",
              .statement =
                  "with constant thrust tau_speed = 2 and yaw moment tau_turn = 0.4 m, the path "
                  "becomes a circle",
              .figure = {},
              .tolerance =
                  fmt::format("a circle is fitted to the last full turn. In every mode, no point "
                              "of that turn is farther from the circle than {:.0f} % of its radius",
                              100.0 * kCircleTolerance),
              .why = {}};
  claim.reproduced = true;
  for (const YawMode mode : kYawModes) {
    const Turn turn = turn_of(model, mode, control);
    claim.figure += (claim.figure.empty() ? "" : "; ") + figure_of(turn);
    claim.reproduced = claim.reproduced && turn.circle &&
                       turn.circle->deviation_m <= kCircleTolerance * turn.circle->radius_m;
  }
  claim.why = fmt::format(
      "with constant forces, surge speed u, sway speed v and yaw rate r become constant, so the "
      "path is a circle. The diameters differ because the limits of each mode allow different yaw "
      "moments: {}",
      delivered_moments(model, plant));
  return claim;
}

Claim check_time_constants(const std::optional<ModeGains>& gains) {
  const HeadingGains<double>& paper = kPaperGains.heading;
  const double t1_s = paper.sliding_time_constant_s();
  const double t2_s = paper.reaching_time_constant_s();
  Claim claim{
      .id = "C14",
      .statement =
          "with the gains lambda = 3, mu = 50, epsilon = 12 of the heading law, the heading error "
          "decays with the time constant T1 = 0.33 s, and the square of the sliding variable S "
          "with T2 = 0.12 s",
      .figure = fmt::format("T1 = 1/lambda = {:.4f} s, T2 = epsilon/(2 mu) = {:.4f} s", t1_s, t2_s),
      .tolerance =
          "T1 and T2 differ from the paper's values by at most 0.005 s, half a unit of the last "
          "printed digit",
      .why = fmt::format("T1 and T2 follow from the gains alone. On the sliding surface S = 0, the "
                         "heading error decays with T1. On the way to the surface, S^2/2 decays "
                         "with T2 and S itself with 2 T2 = {:.2f} s, which is {} T1",
                         2.0 * t2_s, 2.0 * t2_s < t1_s ? "also below" : "not below")};
  claim.reproduced = std::abs(t1_s - 0.33) <= 0.005 && std::abs(t2_s - 0.12) <= 0.005;
  const auto add = [&](std::string_view which, const HeadingGains<double>& heading) {
    claim.figure +=
        fmt::format("; with {}: T1 {:.4f} s, T2 {:.4f} s", which, heading.sliding_time_constant_s(),
                    heading.reaching_time_constant_s());
  };
  if (gains) add("the gains in use", gains->common().heading);
  for (const YawMode mode : kYawModes) {
    if (gains && gains->has_own(mode)) {
      add(fmt::format("those of mode {}", name_of(mode)), gains->in(mode).heading);
    }
  }
  return claim;
}

}  // namespace awmr
