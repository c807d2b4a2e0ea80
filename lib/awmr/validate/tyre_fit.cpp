#include "awmr/validate/tyre_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/validate/tyre_windows.h"

namespace awmr::tyre_fit {
namespace {

/// Minimum number of windows with differential turns, and of windows with steered turns.
constexpr std::size_t kMinTurns = 3;

Estimate estimate_of(double log_value, double log_error, std::size_t windows) {
  const double value = std::exp(log_value);
  const double factor = std::exp(t_quantile_95(static_cast<double>(windows) - 2.0) * log_error);
  return {.value = value,
          .std_error = value * log_error,
          .ci95 = Interval{value / factor, value * factor},
          .source = Source::kFitted,
          .method = "four-wheel"};
}

Finding finding(const DrivingLog& log, Severity severity, const char* code, std::string message) {
  return {log.file, 0, severity, code, std::move(message)};
}

/// Finding `tyres-need-turns` if there are too few windows, or too few windows with one kind of
/// turn; otherwise empty.
std::optional<Finding> missing_turns(const std::vector<ReplayedWindow>& windows,
                                     const DrivingLog& log, const Vehicle& vehicle,
                                     const Plant<double>& plant) {
  std::size_t by_sides = 0;
  std::size_t by_steering = 0;
  for (const ReplayedWindow& window : windows) {
    const Turns turns = turns_in(window.rows, plant);
    by_sides += turns.by_sides ? 1U : 0U;
    by_steering += turns.by_steering ? 1U : 0U;
  }
  const bool steers = vehicle.has_steering();
  const bool enough = windows.size() >= kMinTyreWindows && by_sides >= kMinTurns &&
                      (!steers || by_steering >= kMinTurns);
  if (enough) return std::nullopt;
  return finding(
      log, Severity::kError, "tyres-need-turns",
      fmt::format("a fit of the tyres needs at least {} windows of {:g} s, {} of them with each "
                  "kind of turn; these logs have {} windows, {} with turns by different left and "
                  "right wheel forces{} (a turn by forces and steering together counts as neither "
                  "kind). Record a drive that turns {}",
                  kMinTyreWindows, kWindow_s, kMinTurns, windows.size(), by_sides,
                  steers ? fmt::format(" and {} with steered turns", by_steering) : "",
                  steers
                      ? "by wheel forces with straight wheels, then by steering with equal forces, "
                        "then by steering while it coasts"
                      : "by wheel forces at several speeds"));
}

/// Sums of squared errors of both plants, on windows that were not used to fit the tyres.
struct HeldOutSums {
  ErrorSums model;
  ErrorSums four_wheel;
  /// For each window: the error sums of the 3-DOF model, then those of the four-wheel plant.
  std::vector<std::pair<ErrorSums, ErrorSums>> by_window;
};

/// Cross-validation: fits the tyres to every other window and predicts the remaining windows, then
/// exchanges the two halves. Empty if a fit does not converge or a window cannot be replayed.
std::optional<HeldOutSums> held_out(const Windows& windows, const Plants& plants,
                                    const ShownFit& shown) {
  HeldOutSums sums;
  for (const std::size_t fold : {0U, 1U}) {
    Windows fitted;
    Windows rest;
    for (std::size_t i = 0; i < windows.size(); ++i)
      (i % 2 == fold ? fitted : rest).push_back(windows[i]);
    const auto tyres = fit(fitted, plants, shown.is_free, shown.fit.at);
    if (!tyres || !tyres->converged) return std::nullopt;
    for (const ReplayedWindow* window : rest) {
      const Eigen::VectorXd by_model = errors_of_model(*window, plants);
      const auto on_tyres = errors_on_tyres(*window, plants, tyres->at);
      if (!on_tyres || !by_model.allFinite()) return std::nullopt;
      std::pair<ErrorSums, ErrorSums> both;
      both.first.add(*window, by_model);
      both.second.add(*window, *on_tyres);
      sums.model.add(*window, by_model);
      sums.four_wheel.add(*window, *on_tyres);
      sums.by_window.push_back(both);
    }
  }
  return sums;
}

/// The plant with the smaller errors on held-out windows. Empty if the 95 % interval of the mean of
/// D_w (tyre_fit.h) contains 0.
std::optional<PlantKind> better_plant(const HeldOutSums& sums) {
  std::vector<double> differences;
  for (const auto& [by_model, on_tyres] : sums.by_window) {
    double difference = 0.0;
    for (std::size_t c = 0; c < kChannelCount; ++c) {
      if (!(by_model.squares[c] > 0.0) || !(on_tyres.squares[c] > 0.0)) continue;
      difference += std::log(by_model.squares[c] / on_tyres.squares[c]);
    }
    differences.push_back(difference);
  }
  const auto count = static_cast<double>(differences.size());
  const Eigen::Map<const Eigen::VectorXd> d(differences.data(), rows_of(differences));
  const double mean = d.mean();
  const double half = t_quantile_95(count - 1.0) *
                      std::sqrt((d.array() - mean).square().sum() / (count - 1.0) / count);
  if (mean > half) return PlantKind::kFourWheel;
  if (mean < -half) return PlantKind::kModel;
  return std::nullopt;
}

std::vector<HeldOutError> errors_by_channel(const HeldOutSums& sums) {
  std::vector<HeldOutError> errors;
  for (const LogChannel channel : kChannels) {
    const std::size_t c = at(channel);
    if (!(sums.model.count[c] > 0.0)) continue;
    errors.push_back({std::string(info(channel).name), std::sqrt(sums.model.mean_square(c)),
                      std::sqrt(sums.four_wheel.mean_square(c))});
  }
  return errors;
}

std::string comparison_text(const TyreFit& tyres) {
  std::string text;
  for (const HeldOutError& error : tyres.held_out) {
    text +=
        fmt::format("{}{} {:.3g} on four wheels and {:.3g} in the 3-DOF model",
                    text.empty() ? "" : ", ", error.channel, error.four_wheel_rms, error.model_rms);
  }
  const std::string verdict = !tyres.better ? "neither plant predicts better"
                              : *tyres.better == PlantKind::kFourWheel
                                  ? "the four-wheel plant predicts better than the 3-DOF model"
                                  : "the 3-DOF model predicts better than the four-wheel plant";
  return fmt::format(
      "over {} windows of {:g} s, each predicted by a fit without this window, {} (RMS errors, SI "
      "units: {})",
      tyres.windows, kWindow_s, verdict, text);
}

/// If the logs do not determine the parameter, adds a finding and returns empty.
std::optional<Estimate> estimate_or_held(const ShownFit& shown, Eigen::Index p, std::size_t windows,
                                         const DrivingLog& log, std::vector<Finding>& findings) {
  if (shown.is_free[at(p)]) return estimate_of(shown.fit.at[p], *shown.errors[at(p)], windows);
  const char* name = p == kFriction ? "friction" : "cornering stiffness";
  const char* trial = p == kFriction
                          ? "tighter and faster turns with more force, in which the tyres slide"
                          : "gentle steering at speed, and steering while coasting";
  findings.push_back(
      finding(log, Severity::kWarning, "tyres-not-shown",
              fmt::format("the logs do not determine the {} of the tyres, which keeps its default "
                          "{:g}. Record {}",
                          name, std::exp(default_tyres()[p]), trial)));
  return std::nullopt;
}

/// True if a log has longer time steps than the controller, and so lacks commands.
bool lose_commands(const std::vector<DrivingLog>& logs, double sample_time_s) {
  // Largest ratio of time step to sample time that jitter of the time stamps explains.
  constexpr double kLonger = 1.2;
  return std::ranges::any_of(
      logs, [&](const DrivingLog& log) { return log.median_step_s() > kLonger * sample_time_s; });
}

/// Returns the logs with every other command removed: each remaining command is held over two rows.
std::vector<DrivingLog> with_half_of_the_commands(std::vector<DrivingLog> logs) {
  for (DrivingLog& log : logs) {
    const auto hold = [&](std::vector<double>& command) {
      for (std::size_t row = 1; row < log.rows(); row += 2) command[row] = command[row - 1];
    };
    hold(log.force_left);
    hold(log.force_right);
    if (log.steering_command_rad) hold(*log.steering_command_rad);
  }
  return logs;
}

/// Increases the standard errors by the error that unknown commands between the rows of a slow log
/// cause (tyre_fit.h). To estimate this error, repeats the fit without every other logged command.
/// Half of the resulting change is added in quadrature, so that a 95 % interval includes the
/// change. Returns false if the repeated fit does not converge.
bool add_error_of_lost_commands(const std::vector<DrivingLog>& logs, const Plant<double>& plant,
                                double motor_lag_s, const Plants& plants, ShownFit& shown) {
  const std::vector<DrivingLog> halved = with_half_of_the_commands(logs);
  const std::vector<ReplayedLog> replayed = replayed_logs(halved, plant, motor_lag_s);
  const std::vector<ReplayedWindow> all = windows_in(halved, replayed);
  const auto again = fit(evenly_chosen(all), plants, shown.is_free, shown.fit.at);
  if (!again || !again->converged) return false;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    std::optional<double>& error = shown.errors[at(p)];
    if (error) error = std::hypot(*error, 0.5 * (again->at[p] - shown.fit.at[p]));
  }
  return true;
}

double motor_lag_s(const Model& model) { return model.vehicle.motor_time_constant_s.value_or(0.0); }

tl::unexpected<Finding> refuse(const DrivingLog& log, const char* code, std::string why) {
  return tl::unexpected(finding(log, Severity::kError, code, std::move(why)));
}

/// The tyres that these windows determine. Error: the finding with the reason why there is no fit.
tl::expected<ShownFit, Finding> shown_tyres(const std::vector<DrivingLog>& logs, const Model& model,
                                            const Plant<double>& plant, const Plants& plants,
                                            const Windows& windows) {
  const DrivingLog& first = logs.front();
  auto shown = fit_what_is_shown(windows, plants);
  if (!shown) {
    return refuse(first, "tyres-not-converged",
                  "the logs cannot be replayed on the four-wheel plant, even with the shortest "
                  "integration step; check the units, the columns and the model");
  }
  if (!shown->is_free[kFriction] && !shown->is_free[kCornering]) {
    return refuse(
        first, "tyres-not-shown",
        "the logs determine neither the friction nor the cornering stiffness of the tyres; record "
        "tighter and faster turns by wheel forces and by steering");
  }
  if (!shown->fit.converged) {
    return refuse(
        first, "tyres-not-converged",
        "the fit of the tyres did not converge; check the units, the columns and vehicle.json. "
        "Reason: " +
            shown->fit.stop_reason);
  }
  if (lose_commands(logs, model.vehicle.sample_time_s) &&
      !add_error_of_lost_commands(logs, plant, motor_lag_s(model), plants, *shown)) {
    return refuse(
        first, "tyres-not-converged",
        "the log lacks commands between its rows, and their effect on the tyres cannot "
        "be estimated: a fit that uses only every second logged command does not converge. Log "
        "every command of the controller");
  }
  return *std::move(shown);
}

Status check_vehicle(const Model& model) {
  if (model.vehicle.driven_wheels() == 4) return {};
  return input_error(
      ErrorCode::kUnsupported, option_text("tyres"),
      fmt::format("the four-wheel plant needs four driven wheels, which a vehicle of drive \"{}\" "
                  "does not have; leave the option out",
                  name_in(kDriveNames, model.vehicle.drive)));
}

/// Adds the note `plants-compared`, and the warning `inertia-of-logs` if I'z was fitted to logs.
void note_comparison(const DrivingLog& log, const Model& model, const TyreFit& tyres,
                     std::vector<Finding>& findings) {
  if (model[ParameterId::kInertiaNorm].source == Source::kFitted) {
    findings.push_back(finding(
        log, Severity::kWarning, "inertia-of-logs",
        "I'z of the model was fitted to logs with the 3-DOF model and can include yaw moments of "
        "the tyres. For the four-wheel plant, use a model identified from tables (I'z = m' Iz/m)"));
  }
  findings.push_back(finding(log, Severity::kNote, "plants-compared", comparison_text(tyres)));
}

}  // namespace
}  // namespace awmr::tyre_fit

namespace awmr {

Result<std::optional<TyreFit>> fit_tyres(const std::vector<DrivingLog>& logs, const Model& model,
                                         std::vector<Finding>& findings) {
  using namespace tyre_fit;
  AWMR_RETURN_IF_ERROR(check_vehicle(model));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_RETURN_IF_ERROR(check_replay(plant, model.file));
  const DrivingLog& first = logs.front();
  const auto fail = [&](Finding why) {
    findings.push_back(std::move(why));
    return std::optional<TyreFit>();
  };
  const Plants plants(plant);
  const std::vector<ReplayedLog> replayed = replayed_logs(logs, plant, motor_lag_s(model));
  const std::vector<ReplayedWindow> all = windows_in(logs, replayed);
  if (auto missing = missing_turns(all, first, model.vehicle, plant)) return fail(*missing);
  const Windows windows = evenly_chosen(all);
  const auto shown = shown_tyres(logs, model, plant, plants, windows);
  if (!shown) return fail(shown.error());
  const auto sums = held_out(windows, plants, *shown);
  if (!sums) {
    return fail(
        finding(first, Severity::kError, "tyres-not-converged",
                "the fit of the tyres to every second window of the logs does not converge, so the "
                "four-wheel plant cannot be compared with the 3-DOF model; record a longer drive"));
  }
  TyreFit tyres{
      .tyres = tyres_at(shown->fit.at),
      .friction = estimate_or_held(*shown, kFriction, windows.size(), first, findings),
      .cornering_per_rad = estimate_or_held(*shown, kCornering, windows.size(), first, findings),
      .windows = static_cast<int>(windows.size()),
      .held_out = errors_by_channel(*sums),
      .better = better_plant(*sums)};
  note_comparison(first, model, tyres, findings);
  return std::optional(std::move(tyres));
}

}  // namespace awmr
