/// Output-error fit of the whole model to driving logs. Private to identify/.
///
/// The model is simulated with the logged commands and compared with all measurements. Each window
/// of the logs has its own initial state. The noise of each channel is estimated from the
/// residuals, and residuals that are correlated in time are whitened.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/logs/problem/channel_noise.h"
#include "awmr/model/record.h"

namespace awmr {

struct LogFit {
  std::vector<FreeQuantity> quantities;
  std::vector<double> coordinates;  ///< one per quantity: its value, or the logarithm of it
  /// Initial states of all windows at the optimum (SearchPoint::initial_states).
  std::vector<double> initial_states;
  Eigen::MatrixXd covariance;  ///< covariance of the coordinates; large variance: not identified
  /// One per quantity; empty text: the quantity is identified.
  std::vector<std::string> refusal_reason;
  NoiseLevels noise;
  /// Part of -2 ln L due to uncertain times of command changes (WindowErrors::change_cost).
  double change_cost = 0.0;
  /// Likeliest times of these changes, all windows (WindowErrors::change_times).
  std::vector<double> change_times;
  /// Largest distance, s, of a change of the commands at an uncertain time from its expected time;
  /// 0 if all times are known. A delay of all commands up to this distance cannot be told from
  /// such changes.
  double change_reach_s = 0.0;
  ErrorsBySensor errors;  ///< model + bias - measured at the optimum, SI; not whitened
  /// One per term in LogFitOptions::candidate_terms: the decrease of -2 ln L, >= 0, that a score
  /// test predicts for a fit that also estimates this term.
  std::vector<double> candidate_gain;
  double widened = 1.0;    ///< largest factor by which a standard error was raised
  EstimatorReport report;  ///< report for /estimates of model.json
  bool usable = false;     ///< true if the final search converged
  /// Mean square of the errors at the optimum, relative to the noise by sensor_noise(): about 1 if
  /// the model is right. If the fit gave up, this is the value after the first round of
  /// settle_noise().
  double relative_error = 0.0;
  /// True: the fit stopped early, because its errors were too large, or hardly smaller than those
  /// of the best fit, after its quick searches (LogFitOptions::best_so_far), or because they were
  /// too large after the first round (LogFitOptions::give_up_above). The fit is then not usable. Of
  /// its results only `quantities`, `coordinates`, `relative_error` and `report` are set.
  bool gave_up = false;
  /// True: the fit stopped early, because the commands of the logs probably change between rows
  /// (LogFitOptions::tests_changes). The fit is then not usable. Of its results only `quantities`
  /// and `coordinates` are set.
  bool has_changes_between_rows = false;

  /// True if the errors of a channel have a drift that sensor noise does not explain
  /// (ChannelNoise::of_the_model()).
  bool has_model_error() const {
    return std::ranges::any_of(noise,
                               [](const auto& channel) { return channel.second.of_the_model(); });
  }
  /// True if the errors of a channel have a drift that is large and long compared with the noise of
  /// its sensor (ChannelNoise::overwhelms_sensor()): the model is probably wrong.
  bool has_large_drift() const {
    return std::ranges::any_of(
        noise, [](const auto& channel) { return channel.second.overwhelms_sensor(); });
  }
  /// Value of the first quantity that is `what` (place_of()). Empty if there is none.
  template <class What>
  std::optional<double> value_of(What what) const {
    const auto i = place_of(quantities, what);
    return i ? std::optional(quantities[*i].value(coordinates[*i])) : std::nullopt;
  }
  /// Removes quantity i and its coordinate. The other results keep their values.
  void remove(std::size_t i) {
    const auto place = static_cast<std::ptrdiff_t>(i);
    quantities.erase(quantities.begin() + place);
    coordinates.erase(coordinates.begin() + place);
  }
  double error_of(std::size_t i) const {
    return std::sqrt(covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
  }
  /// True if quantity i (delay, lag, back-EMF, error of commands or sensors) differs significantly
  /// from 0: by at least two standard errors, and by at least 1e-3 in its SI unit (1e-6 s^2 for
  /// smoothing). Precondition: the coordinate of the quantity is its value, not a logarithm.
  bool is_significant(std::size_t i) const {
    const double smallest = quantities[i].kind == FreeQuantity::Kind::kSmoothing ? 1e-6 : 1e-3;
    return !(std::abs(coordinates[i]) < std::max(smallest, 2.0 * error_of(i)));
  }
};

/// Fits the logs. Precondition: an initial guess for every parameter. The fit is not usable and has
/// no quantities if nothing is measured, if no quantity is free, if there are not more readings
/// than unknowns, or if all searches fail. Its report then states the reason.
LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// Makes a quick fit, only to rank models: one search from the initial guess, with short parts of
/// the logs and long integration steps (rough_problem()). Sets only `quantities`, `coordinates`,
/// `initial_states` and `relative_error` of the result. `relative_error` is infinite if the search
/// fails.
LogFit fit_roughly(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// Returns the options with the delays and command errors of `fit` as free terms, starting at their
/// fitted values. Unchanged if `fit` has no quantities.
LogFitOptions with_terms_of(const LogFit& fit, LogFitOptions options);

/// Values of all parameters after the fit, fitted and fixed ones.
ParameterValues<double> fitted_values(const LogFitOptions& options, const LogFit& fit);

}  // namespace awmr
