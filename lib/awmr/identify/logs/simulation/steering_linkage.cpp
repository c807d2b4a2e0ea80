#include "awmr/identify/logs/simulation/steering_linkage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/choice/term_trials.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/logs/problem/score_test.h"
#include "awmr/identify/logs/problem/widening.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

bool has_linkage_error(const std::vector<FreeQuantity>& quantities) {
  return std::ranges::any_of(quantities, &FreeQuantity::is_of_linkage);
}

/// True if a row of the window has a command with which the wheels would point beyond the stop.
bool is_stop_reached_in(const FitWindow& window, CommandPath path) {
  const DrivingLog& log = *window.rows.log;
  if (!log.steering_command_rad) return false;
  path.stop_limits_command = false;
  for (std::size_t row = window.rows.begin; row < window.rows.end; ++row) {
    const double angle_rad = command_of_rows(log, {row, row}, path).command.steering_rad;
    if (std::abs(angle_rad) > path.steering_stop_rad) return true;
  }
  return false;
}

bool limits_command(const std::vector<FreeQuantity>& quantities) {
  return std::ranges::any_of(quantities, &FreeQuantity::is_beyond_stop);
}

/// Sets for an error of the linkage whether the stop limits the command (else the angle).
void set_limit(bool is_of_command, FreeQuantity& q) {
  q.is_beyond_stop = q.is_of_linkage() && is_of_command;
}

std::string_view limited_by_stop(const FamilyFit& fit) {
  return limits_command(fit.fit.quantities) ? "command" : "angle";
}

/// Scale s of the steering angles at one standard deviation, see widen_by_steering_scale(). With a
/// curve, s brings the angle at the stop closer to the command.
double possible_scale(const LogFit& fit) {
  const double asymmetry = fit.value_of(Kind::kSteeringAsymmetry).value_or(0.0);
  const double log_curve = std::log1p(fit.value_of(Kind::kSteeringCurve).value_or(0.0));
  return std::exp(std::copysign(std::hypot(asymmetry, log_curve), -log_curve));
}

std::vector<DrivingLog> with_scaled_steering(std::vector<DrivingLog> logs, double scale) {
  for (DrivingLog& log : logs) {
    if (!log.steering_command_rad) continue;
    for (double& command_rad : *log.steering_command_rad) command_rad *= scale;
  }
  return logs;
}

/// Fits the logs again with steering angles of `scale` times those of the fit `chosen`.
FamilyFit fit_with_scale(const std::vector<DrivingLog>& logs, const FamilyFit& chosen,
                         double scale) {
  LogFitOptions options = from_optimum(chosen.options, chosen);
  options.noise = chosen.fit.noise;
  options.bootstrap = 0;
  options.vehicle.steering_max_deg *= scale;
  options.vehicle.steering_max_rate_degps *= scale;
  return fit_with(with_scaled_steering(logs, scale), options, chosen.surge, chosen.yaw);
}

}  // namespace

bool is_stop_reached(const LogProblem& problem, const SearchPoint& point) {
  if (!has_linkage_error(problem.model.quantities)) return false;
  for (std::size_t w = 0; w < problem.windows.size(); ++w) {
    const double* const initial = point.initial_states.data() + w * problem.model.initial.size();
    const FitWindow& window = problem.windows[w];
    const SimulatedVehicle vehicle =
        vehicle_at(problem.model, window, point.coordinates.data(), initial);
    if (is_stop_reached_in(window, vehicle.path)) return true;
  }
  return false;
}

std::optional<NoiseIteration> with_other_stop(const NoiseIteration& settled) {
  if (!is_stop_reached(settled.problem, settled.point)) return std::nullopt;
  LogProblem problem = with_white_noise(settled.problem);
  const bool limits_other = !limits_command(problem.model.quantities);
  for (FreeQuantity& q : problem.model.quantities) set_limit(limits_other, q);
  NoiseIteration fit = settle_noise(std::move(problem), settled.point);
  if (!(akaike_of(fit) < akaike_of(settled))) return std::nullopt;
  return fit;
}

std::optional<Finding> decide_stop(const std::vector<DrivingLog>& logs, FamilyFit& chosen) {
  if (!chosen.fit.usable || !has_linkage_error(chosen.fit.quantities)) return std::nullopt;
  LogFitOptions options = from_optimum(chosen.options, chosen);
  const LogProblem problem = log_problem(logs, options);
  if (!is_stop_reached(problem, from_measured(problem, problem.initial))) return std::nullopt;
  const bool limits_other = !limits_command(chosen.fit.quantities);
  for (FreeTerm& term : options.terms) set_limit(limits_other, term.quantity);
  FamilyFit other = fit_with(logs, options, chosen.surge, chosen.yaw);
  if (!other.fit.usable) return std::nullopt;
  if (aic_lead(other.fit, chosen.fit) > 0.0) std::swap(other, chosen);
  const double lead = aic_lead(chosen.fit, other.fit);
  if (!(lead < kTermAicThreshold)) return std::nullopt;
  const std::vector<std::string> names = withdraw_different(other.fit.report, chosen.fit.report);
  if (names.empty()) return std::nullopt;
  return Finding{
      logs.front().file, 0, Severity::kWarning, "steering-stop",
      fmt::format(
          "these logs do not decide whether the steering stop limits the {} or the {}: "
          "the AIC of the fit with the first limit, which is used, is lower by only {:.1f}, "
          "so the intervals of {} are withdrawn. Log the measured angle as steering_deg, or "
          "longer turns at the stop",
          limited_by_stop(chosen), limited_by_stop(other), lead, fmt::join(names, ", "))};
}

void widen_by_steering_scale(const std::vector<DrivingLog>& logs, FamilyFit& chosen) {
  LogFit& fit = chosen.fit;
  const bool has_scale = has(fit.quantities, Kind::kSteeringScale);
  const double scale = possible_scale(fit);
  if (!fit.usable || has_scale || scale == 1.0) return;
  const LogFit other = fit_with_scale(logs, chosen, scale).fit;
  if (!other.usable) return withdraw_intervals(fit.report);
  // Both fits have the same quantities, so their AIC differs by the difference of -2 ln L.
  const double share = 1.0 / std::sqrt(1.0 + std::max(0.0, aic_lead(fit, other)));
  Eigen::VectorXd change = Eigen::VectorXd::Zero(rows_of(fit.quantities));
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const Eigen::Index row = eigen_index(i);
    if (!fit.refusal_reason[i].empty()) continue;
    const std::size_t same = *place_of(other.quantities, fit.quantities[i].name());
    change(row) = share * (other.coordinates[same] - fit.coordinates[i]);
  }
  widen_by(change, fit);
}

bool is_much_curved(const LogFit& fit) {
  constexpr double kLargestStraight = 0.05;
  return std::abs(fit.value_of(Kind::kSteeringCurve).value_or(0.0)) > kLargestStraight;
}

}  // namespace awmr
