#include "awmr/simulate/validity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "awmr/control/directed_speed.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/finding_rank.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/paper_gains.h"
#include "awmr/model/steady.h"
#include "awmr/model/transform.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

void note_late_steps(const Scenario& scenario, std::vector<Finding>& findings) {
  const auto* headings = std::get_if<HeadingSteps>(&scenario.guidance);
  if (headings == nullptr || headings->steps.back().t_s < scenario.duration_s) return;
  findings.push_back(
      {"", 0, Severity::kWarning, "late-step",
       fmt::format(
           "{}: the heading step at {:g} s has no effect, because the run ends at {:g} s; give a "
           "longer duration_s",
           scenario.name, headings->steps.back().t_s, scenario.duration_s)});
}

void note_blocked_waypoints(const Scenario& scenario, std::vector<Finding>& findings) {
  const auto* path = std::get_if<WaypointPath>(&scenario.guidance);
  if (path == nullptr) return;
  for (std::size_t i = 0; i < path->points_m.size(); ++i) {
    for (const Obstacle<double>& obstacle : scenario.obstacles) {
      const double apart_m = std::hypot(path->points_m[i].x_m - obstacle.centre_m.x_m,
                                        path->points_m[i].y_m - obstacle.centre_m.y_m);
      if (apart_m > obstacle.radius_m) continue;
      findings.push_back({"", 0, Severity::kWarning, "blocked-waypoint",
                          fmt::format("{}: waypoint {} (counted from 1) lies within an obstacle; "
                                      "move the waypoint or the obstacle",
                                      scenario.name, i + 1)});
    }
  }
}

void note_speed(const Scenario& scenario, const Model& model, std::vector<Finding>& findings) {
  if (std::holds_alternative<OpenLoop>(scenario.guidance)) return;
  const Plant<double> plant = model.plant_as_known();
  const double most = driven_wheels(plant) * (model.vehicle.wheel_force.hi - plant.wheel_dead_zone -
                                              plant.back_emf_s_per_m * scenario.speed_mps);
  const double needed = plant.surge(scenario.speed_mps);
  if (!(needed > most)) return;
  findings.push_back({"", 0, Severity::kWarning, "unreachable-speed",
                      fmt::format("{}: a speed of {:g} m/s needs a force of {:.3g} F_max "
                                  "(largest force of one motor), but all motors together make at "
                                  "most {:.3g} F_max; give a smaller speed_mps",
                                  scenario.name, scenario.speed_mps, needed, std::max(most, 0.0))});
}

/// Simulates a turn of 10 s in open loop, with half of the largest thrust and the yaw moment
/// tau_turn_m, and returns the magnitude of the final yaw rate, deg/s. With `tyres`, the vehicle is
/// on these tyres; without, it is the 3-DOF model.
double turned_degps(const Model& model, double tau_turn_m,
                    const std::optional<Tyres<double>>& tyres) {
  Scenario turn;
  turn.name = "turn";
  turn.duration_s = 10.0;
  turn.speed_mps = 0.0;
  const Plant<double> plant = model.plant_as_known();
  turn.guidance = OpenLoop{0.5 * driven_wheels(plant) * model.vehicle.wheel_force.hi, tau_turn_m};
  turn.tyres = tyres;
  const YawMode mode = model.vehicle.has_steering() ? YawMode::kSteering : YawMode::kDifferential;
  const Run run = simulate(plant, make_controller(plant, model.vehicle, kPaperGains), turn, mode,
                           {.sample_time_s = model.vehicle.sample_time_s});
  return std::abs(degrees(run.rows.back().state.r_radps));
}

}  // namespace

std::optional<Finding> missing_intervals(const Model& model) {
  std::vector<std::string_view> missing;
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    const Estimate& e = model.estimates[i];
    if (!e.value || e.source == Source::kGiven || e.std_error || e.ci95) continue;
    missing.push_back(parameter_table()[i].symbol);
  }
  if (missing.empty()) return std::nullopt;
  std::set<std::string> causes;
  for (const Finding& finding : model.record.findings) {
    if (effect_of(finding) == Effect::kWithdrawn) causes.insert(finding.code);
  }
  return Finding{
      model.file, 0, Severity::kWarning, "no-interval",
      fmt::format("{} of the model {} no 95 % interval{}: the error of such a value is unknown, "
                  "and random vehicles drawn from the model all have the same value. Follow the "
                  "findings of identify and identify again before driving with this model",
                  fmt::join(missing, ", "), missing.size() == 1 ? "has" : "have",
                  causes.empty() ? "" : fmt::format(" (identify: {})", fmt::join(causes, ", ")))};
}

std::vector<Finding> imprecise_parameters(const Model& model) {
  std::vector<Finding> findings;
  const Covariance& covariance = model.covariance;
  for (std::size_t i = 0; i < covariance.parameters.size(); ++i) {
    const ParameterInfo& parameter = info(covariance.parameters[i]);
    const std::optional<double>& value = model[parameter.id].value;
    if (!value || scale_of(parameter.id) != Scale::kLogarithmic) continue;
    const double sigma = std::sqrt(covariance.matrix[i][i]) / *value;
    if (!(sigma > kImprecise)) continue;
    findings.push_back(
        {model.file, 0, Severity::kWarning, "imprecise-parameter",
         fmt::format("{} is {:.3g} {} with a standard error of {:.3g} times this value: vehicles "
                     "drawn from the model differ from each other by large factors, and results "
                     "over these vehicles depend mainly on this error. Record {}, and identify "
                     "again",
                     parameter.symbol, *value, parameter.unit, sigma,
                     trial_of(model.vehicle, parameter.id))});
  }
  return findings;
}

std::optional<Finding> tyres_differ(const Scenario& scenario, const Model& model) {
  const std::optional<double> measured_degps = measured_yaw_rate_degps(model);
  if (!scenario.tyres || !measured_degps) return std::nullopt;
  const double moment_m = model.plant_as_known().yaw(radians(*measured_degps));
  const double plain_degps = turned_degps(model, moment_m, {});
  const double on_tyres_degps = turned_degps(model, moment_m, scenario.tyres);
  // Ratio of the two yaw rates above which `tyres-differ` is reported. A smaller limit warns of
  // tyres that match the vehicle only roughly.
  constexpr double kMuch = 1.5;
  if (on_tyres_degps <= kMuch * plain_degps && plain_degps <= kMuch * on_tyres_degps) {
    return std::nullopt;
  }
  return Finding{
      model.file, 0, Severity::kWarning, "tyres-differ",
      fmt::format("{}: with the yaw moment that turns the model at {:.3g} deg/s, the highest "
                  "measured rate, the same vehicle on the scenario's tyres turns at {:.3g} deg/s. "
                  "So the tyres of the scenario do not match the vehicle; fit them to logs with "
                  "awmr validate --tyres",
                  scenario.name, plain_degps, on_tyres_degps)};
}

std::vector<Finding> unattainable_requests(const Scenario& scenario, const Model& model) {
  std::vector<Finding> findings;
  note_late_steps(scenario, findings);
  note_blocked_waypoints(scenario, findings);
  note_speed(scenario, model, findings);
  return findings;
}

void limit_heading_rate(double limit_degps, double sample_time_s, Scenario& scenario) {
  if (std::holds_alternative<OpenLoop>(scenario.guidance)) return;
  const double limit_radps = radians(limit_degps);
  if (scenario.shaping) {
    scenario.shaping->rate_max_radps = std::min(scenario.shaping->rate_max_radps, limit_radps);
    return;
  }
  const double omega_radps = std::min(kShapingBandwidth_radps, kShapingSamples / sample_time_s);
  // With this acceleration limit, the filter reaches its rate limit within its time constant.
  scenario.shaping = HeadingShaping<double>{.omega_radps = omega_radps,
                                            .rate_max_radps = limit_radps,
                                            .accel_max_radps2 = omega_radps * limit_radps};
}

std::string fault_of_rate(const HeadingRateChoice& choice) {
  if (choice == kMeasuredRate || choice == kNoRate) return {};
  const auto rate_degps = number_from_text(choice);
  if (rate_degps && kHeadingRateLimits_degps.contains(*rate_degps)) return {};
  return fmt::format("must be {}, {}, or deg/s from {:g} to {:g}, found {}", kMeasuredRate, kNoRate,
                     kHeadingRateLimits_degps.lo, kHeadingRateLimits_degps.hi,
                     choice.empty() ? "nothing" : choice);
}

HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& choice, const Model& model) {
  if (!choice.empty()) return choice;
  return measured_yaw_rate_degps(model) ? kMeasuredRate : kNoRate;
}

Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios) {
  if (choice.empty() || choice == kNoRate) return {};
  const std::string place = option_text("heading_rate_limit");
  if (const std::string why = fault_of_rate(choice); !why.empty()) {
    return input_error(ErrorCode::kOutOfRange, place, why);
  }
  const std::optional<double> limit_degps =
      choice == kMeasuredRate ? measured_yaw_rate_degps(model) : *number_from_text(choice);
  if (!limit_degps) {
    return input_error(
        ErrorCode::kNotIdentified, place,
        "no trial or log of this model gives a highest yaw rate; give a number in deg/s, or "
        "yaw_rate_max_degps in vehicle.json");
  }
  for (Scenario& scenario : scenarios) {
    limit_heading_rate(*limit_degps, model.vehicle.sample_time_s, scenario);
  }
  return {};
}

std::optional<Finding> heading_rate_not_limited(const HeadingRateChoice& choice,
                                                const Model& model) {
  if (!choice.empty() || measured_yaw_rate_degps(model)) return std::nullopt;
  return Finding{model.file, 0, Severity::kWarning, "heading-rate-not-limited",
                 fmt::format("the heading rate is not limited, because the model has no highest "
                             "measured yaw rate; differences between modes may come from "
                             "extrapolation. Give yaw_rate_max_degps in vehicle.json, or {}",
                             option_text("heading_rate_limit"))};
}

TurnCommands turn_commands(const Scenario& scenario) {
  TurnCommands commands{.are_headings = !std::holds_alternative<OpenLoop>(scenario.guidance)};
  if (commands.are_headings && scenario.shaping) {
    commands.rate_max_degps = degrees(scenario.shaping->rate_max_radps);
  }
  return commands;
}

namespace {

/// Remedy for turns at `fastest_degps` that are faster than those of the trials.
std::string remedy_for_turns(const TurnCommands& commands, double measured_degps,
                             double fastest_degps) {
  constexpr double kRounding = 1e-9;  // relative error of a limit converted to rad/s and back
  const std::string record =
      fmt::format("Record turning trials at up to {:.3g} deg/s", fastest_degps);
  if (!commands.are_headings) return record + ", or give a smaller tau_turn";
  const std::string option = option_text("heading_rate_limit");
  if (!commands.rate_max_degps) {
    return record + ", or limit the rate of heading commands (shaping in the scenario, or " +
           option_text("heading_rate_limit measured") + ")";
  }
  if (*commands.rate_max_degps > measured_degps * (1.0 + kRounding)) {
    return fmt::format(
        "{}, or lower the limit of the heading rate from {:.3g} to {:.3g} deg/s "
        "(shaping in the scenario, or {})",
        record, *commands.rate_max_degps, measured_degps, option);
  }
  const double in_proportion_degps = *commands.rate_max_degps * measured_degps / fastest_degps;
  const double digit = std::pow(10.0, std::floor(std::log10(in_proportion_degps)) - 1.0);
  const std::string lower = fmt::format("{:g}", digit * std::floor(in_proportion_degps / digit));
  return fmt::format(
      "The rate of heading commands is limited to {:.3g} deg/s, but the vehicle overshoots or "
      "slides. {}, or lower the limit in proportion, to about {} deg/s ({})",
      *commands.rate_max_degps, record, lower, option_text("heading_rate_limit " + lower));
}

}  // namespace

std::optional<Finding> extrapolation_finding(const std::string& file,
                                             const std::optional<double>& measured_degps,
                                             double fastest_degps, const std::string& where,
                                             const TurnCommands& commands) {
  if (!measured_degps || fastest_degps <= kLittleFurther * *measured_degps) return std::nullopt;
  return Finding{file, 0, Severity::kWarning, "beyond-trials",
                 fmt::format("{}: the vehicle turns at up to {:.3g} deg/s, {:.2g} times the "
                             "highest rate at which the yaw resistance was measured ({:.3g} "
                             "deg/s); above this rate, the model extrapolates the resistance. {}",
                             where, fastest_degps, fastest_degps / *measured_degps, *measured_degps,
                             remedy_for_turns(commands, *measured_degps, fastest_degps))};
}

namespace {

/// Additional backward force, divided by F_max, of the motors of a vehicle that rolls backward at
/// the speed u = speed_mps while the controller gets |u|. The speed law requests the force F' =
/// -unsigned_push() / n of each of n driven wheels. The drive e of the motor and the force F at the
/// wheel are
///   e = max(F' + k_e u, F'min),   F = e + k_e u
/// F'min is the largest backward force, including the dead zone. A drive e >= 0 does not push
/// backward.
double backward_push(const Plant<double>& plant, double force_min, const SpeedGains<double>& gains,
                     double speed_mps) {
  const double wheels = driven_wheels(plant);
  const double lost = plant.back_emf_s_per_m * speed_mps;
  const double wanted = unsigned_push(plant.surge, plant.mass_norm, gains, speed_mps) / wheels;
  const double drive = std::max(lost - wanted, force_min);
  return drive < 0.0 ? wheels * (-drive - lost) : 0.0;
}

/// unsigned_speed_finding() for the gains of one mode.
std::optional<Finding> runs_away(const Plant<double>& plant, const Vehicle& vehicle,
                                 const SpeedGains<double>& gains, const std::string& file) {
  const double force_min = forces_beyond_dead_zone(vehicle.wheel_force, plant.wheel_dead_zone).lo;
  const double wheels = driven_wheels(plant);
  const double top_mps =
      steady_rate(plant.surge, -wheels * force_min, wheels * plant.back_emf_s_per_m).value_or(0.0);
  constexpr int kSpeeds = 100;
  for (int i = kSpeeds; i >= 0; --i) {
    const double u_mps = i > 0 ? top_mps * i / kSpeeds : feed_forward_rest_speed<double>();
    if (!(u_mps <= top_mps)) continue;
    const double push = backward_push(plant, force_min, gains, u_mps);
    if (!(push > plant.surge(u_mps))) continue;
    return Finding{
        file, 0, Severity::kWarning, "unsigned-speed-runs-away",
        fmt::format("with a speed sensor without a sign (GPS), the vehicle can drive backward by "
                    "itself: at {:.3g} m/s the speed law pushes it backward with {:.3g} F_max, "
                    "more than the resistance g1(u) = {:.3g}. Set speed_unsigned in the sketch, as "
                    "the examples do",
                    u_mps, push, plant.surge(u_mps))};
  }
  return {};
}

}  // namespace

std::optional<Finding> unsigned_speed_finding(const Plant<double>& plant, const Vehicle& vehicle,
                                              const ModeGains& gains, const std::string& file) {
  for (const YawMode mode : yaw_modes(vehicle)) {
    if (auto finding = runs_away(plant, vehicle, gains.in(mode).speed, file)) return finding;
  }
  return {};
}

}  // namespace awmr
