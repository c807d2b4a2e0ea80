#include "awmr/validate/tyre_fit.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "awmr/core/distributions.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/silent_ceres.h"
#include "awmr/core/units.h"
#include "awmr/model/ranges.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

constexpr double kWindow_s = 5.0;
/// Of each kind of turn.
constexpr std::size_t kFewestTurns = 3;
/// A parameter with a larger standard error of its logarithm is not shown.
constexpr double kLargestLogError = 0.5;

/// log mu and log c_a.
using LogTyres = Eigen::Vector2d;
constexpr Eigen::Index kFriction = 0;
constexpr Eigen::Index kCornering = 1;

Tyres<double> tyres_at(const LogTyres& at) {
  Tyres<double> tyres;
  tyres.friction = std::exp(at[kFriction]);
  tyres.cornering_per_rad = std::exp(at[kCornering]);
  return tyres;
}

LogTyres default_tyres() {
  return {std::log(kTyreFriction), std::log(kCorneringStiffness_per_rad)};
}

Interval range_of(Eigen::Index parameter) {
  const NumberRule& rule =
      parameter == kFriction ? kTyreFrictionRule : kCorneringStiffnessRule_per_rad;
  return {std::log(rule.min), std::log(rule.max)};
}

/// The servo's angle at each row, from its commands; empty where the angle itself was logged.
std::vector<double> steering_angles(const DrivingLog& log, const Plant<double>& plant) {
  constexpr double kLongestStep = 0.25;  // of the servo's time constant
  std::vector<double> angles;
  if (!log.steering_command_rad) return angles;
  const std::vector<double>& commands = *log.steering_command_rad;
  angles.push_back(commands.front());
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    const double span_s = log.t_s[row + 1] - log.t_s[row];
    const int steps = steps_in(span_s, kLongestStep * plant.steering_time_constant_s);
    State<double> servo{};
    servo.steering_rad = angles.back();
    for (int i = 0; i < steps; ++i) {
      servo = rk4_step(servo, span_s / steps, [&](const State<double>& at) {
        State<double> rates{};
        rates.steering_rad = steering_rate(plant, at.steering_rad, commands[row]);
        return rates;
      });
    }
    angles.push_back(servo.steering_rad);
  }
  return angles;
}

/// What a replay needs of a log.
struct ReplayedLog {
  LogSignals signals;
  std::optional<LaggedForces> lagged;
  std::vector<double> angles;  ///< steering_angles()

  ReplayedLog(const DrivingLog& log, const Plant<double>& plant, double motor_lag_s)
      : signals(log), angles(steering_angles(log, plant)) {
    if (motor_lag_s > 0.0) lagged.emplace(log, 0, log.rows(), motor_lag_s);
  }
  const LaggedForces* motors() const { return lagged ? &*lagged : nullptr; }
  /// The measured state as the rows begin, with the servo as its commands have left it.
  State<double> state_before(const LogWindow& rows) const {
    State<double> state = measured_initial_state(rows);
    if (!angles.empty()) state.steering_rad = angles[rows.begin];
    return state;
  }
};

struct ReplayedWindow {
  const ReplayedLog* log = nullptr;
  LogWindow rows;
  State<double> initial{};
  std::vector<LogChannel> channels = {};  ///< of the errors, in their order
};

template <class Visit>
void each_measurement(const LogWindow& rows, std::size_t row, Visit visit) {
  for (const LogChannel channel : kChannels) {
    if (is_measurement(*rows.log, channel, row)) visit(channel, (*rows.log)[channel]->value[row]);
  }
}

/// True for rows whose errors count: not those in which the unmeasured part of the initial state decays.
bool counts(const LogWindow& rows, std::size_t row) {
  constexpr double kBegin_s = 1.0;
  return rows.log->t_s[row] - rows.log->t_s[rows.begin] >= kBegin_s;
}

/// Adds the errors of one row to those before.
void add_errors(const ReplayedWindow& window, std::size_t row, const State<double>& state,
                Eigen::VectorXd& errors, Eigen::Index& count) {
  if (!counts(window.rows, row)) return;
  each_measurement(window.rows, row, [&](LogChannel channel, double measured) {
    errors[count++] = channel_of(state, channel) - measured;
  });
}

/// A heading or a position is known but for where the window began: errors of these are about their mean.
Eigen::VectorXd about_their_mean(const ReplayedWindow& window, Eigen::VectorXd errors) {
  for (const LogChannel channel : {LogChannel::kX, LogChannel::kY, LogChannel::kHeading}) {
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      if (window.channels[at(i)] != channel) continue;
      sum += errors[i];
      count += 1.0;
    }
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      if (window.channels[at(i)] == channel) errors[i] -= sum / count;
    }
  }
  return errors;
}

/// The vehicle on both plants, each with the steps that it needs.
struct Plants {
  explicit Plants(const Plant<double>& plant)
      : model_step_s(replay_step_s(plant)),
        model(resolved_beside_friction(plant, model_step_s)),
        four_wheel_step_s(replay_step_s(on_tyres(plant))),
        body(resolved_at_rest_on_tyres(on_tyres(plant), four_wheel_step_s)) {}

  /// Without the resistances that tyres replace, and their short steps.
  static Plant<double> on_tyres(Plant<double> plant) {
    plant.sway_alpha = 0.0;
    plant.yaw = {.alpha = 1e-9, .beta = 1.0};
    return plant;
  }
  double model_step_s;
  Plant<double> model;
  double four_wheel_step_s;
  Plant<double> body;
};

/// The errors of the 3-DOF model; infinite where it diverges.
Eigen::VectorXd errors_of_model(const ReplayedWindow& window, const Plants& plants) {
  Eigen::VectorXd errors(rows_of(window.channels));
  Eigen::Index count = 0;
  replay<double>(
      window.log->signals, window.rows.begin, window.rows.end, plants.model, nullptr,
      plants.model_step_s, window.initial,
      [&](std::size_t row, const State<double>& at) { add_errors(window, row, at, errors, count); },
      window.log->motors());
  return about_their_mean(window, std::move(errors));
}

/// The errors on tyres. None: no step is short enough for them.
std::optional<Eigen::VectorXd> errors_on_tyres(const ReplayedWindow& window, const Plants& plants,
                                               const LogTyres& tyres) {
  Eigen::VectorXd errors(rows_of(window.channels));
  Eigen::Index count = 0;
  const bool resolved = replay(
      window.log->signals, window.rows.begin, window.rows.end,
      FourWheels<double>{plants.body, tyres_at(tyres)}, plants.four_wheel_step_s, window.initial,
      [&](std::size_t row, const State<double>& at) { add_errors(window, row, at, errors, count); },
      window.log->motors());
  if (!resolved || !errors.allFinite()) return std::nullopt;
  return about_their_mean(window, std::move(errors));
}

/// 1/(root mean square error) by channel; 0 for a channel without errors.
using Weights = std::array<double, kChannelCount>;

struct Fit {
  LogTyres at;
  Weights weights{};
  double cost = 0.0;  ///< sum of n_c log(sum e^2 / n_c)
  bool converged = false;
  std::string stop_reason = {};
};

Eigen::VectorXd weighted(const ReplayedWindow& window, const Weights& weights,
                         Eigen::VectorXd errors) {
  for (Eigen::Index i = 0; i < errors.size(); ++i) errors[i] *= weights[at(window.channels[at(i)])];
  return errors;
}

/// Forward differences over a thousandth: the steps of the replay change with the tyres, by halves.
constexpr double kStepOfDerivative = 1e-3;

class TyreCost : public ceres::CostFunction {
 public:
  TyreCost(const ReplayedWindow& window, const Plants& plants, const Weights& weights)
      : window_(window), plants_(plants), weights_(weights) {
    set_num_residuals(static_cast<int>(window.channels.size()));
    *mutable_parameter_block_sizes() = {1, 1};
  }
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const LogTyres tyres{*parameters[kFriction], *parameters[kCornering]};
    const Eigen::Index count = num_residuals();
    const auto errors = errors_on_tyres(window_, plants_, tyres);
    if (!errors) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, count) = weighted(window_, weights_, *errors);
    for (Eigen::Index p = 0; jacobians != nullptr && p < 2; ++p) {
      if (jacobians[p] == nullptr) continue;
      const LogTyres step = kStepOfDerivative * LogTyres::Unit(p);
      const auto above = errors_on_tyres(window_, plants_, tyres + step);
      if (!above) return false;
      Eigen::Map<Eigen::VectorXd>(jacobians[p], count) =
          weighted(window_, weights_, (*above - *errors) / kStepOfDerivative);
    }
    return true;
  }

 private:
  const ReplayedWindow& window_;
  const Plants& plants_;
  const Weights& weights_;
};

using Windows = std::vector<const ReplayedWindow*>;

/// Number and sum of squares of the errors by channel.
struct ErrorSums {
  std::array<double, kChannelCount> squares{};
  std::array<double, kChannelCount> count{};

  void add(const ReplayedWindow& window, const Eigen::VectorXd& errors) {
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      const std::size_t channel = at(window.channels[at(i)]);
      squares[channel] += errors[i] * errors[i];
      count[channel] += 1.0;
    }
  }
  double mean_square(std::size_t channel) const {
    return count[channel] > 0.0 ? squares[channel] / count[channel] : 0.0;
  }
  Weights weights() const {
    Weights of{};
    for (std::size_t c = 0; c < kChannelCount; ++c) {
      if (squares[c] > 0.0) of[c] = 1.0 / std::sqrt(mean_square(c));
    }
    return of;
  }
  double cost() const {
    double sum = 0.0;
    for (std::size_t c = 0; c < kChannelCount; ++c) {
      if (squares[c] > 0.0) sum += count[c] * std::log(mean_square(c));
    }
    return sum;
  }
};

std::optional<ErrorSums> sums_on_tyres(const Windows& windows, const Plants& plants,
                                       const LogTyres& tyres) {
  ErrorSums sums;
  for (const ReplayedWindow* window : windows) {
    const auto errors = errors_on_tyres(*window, plants, tyres);
    if (!errors) return std::nullopt;
    sums.add(*window, *errors);
  }
  return sums;
}

using IsFree = std::array<bool, 2>;

ceres::Problem problem_of(const Windows& windows, const Plants& plants, const Weights& weights,
                          const IsFree& is_free, LogTyres& at) {
  ceres::Problem problem;
  for (const ReplayedWindow* window : windows) {
    problem.AddResidualBlock(new TyreCost(*window, plants, weights), nullptr, &at[kFriction],
                             &at[kCornering]);
  }
  for (const Eigen::Index p : {kFriction, kCornering}) {
    problem.SetParameterLowerBound(&at[p], 0, range_of(p).lo);
    problem.SetParameterUpperBound(&at[p], 0, range_of(p).hi);
    if (!is_free[awmr::at(p)]) problem.SetParameterBlockConstant(&at[p]);
  }
  return problem;
}

/// The best points of a coarse grid, by every third window, best first. Vehicles that slide spin one way or
/// the other by little, so that the cost may have several minima.
std::vector<LogTyres> starts_of(const Windows& windows, const Plants& plants) {
  constexpr std::array kFrictions{0.25, 0.5, 0.75, 1.1};
  constexpr std::array kStiffnesses{3.0, 6.0, 12.0, 24.0};
  constexpr std::size_t kMostStarts = 3;
  Windows some;
  for (std::size_t i = 0; i < windows.size(); i += 3) some.push_back(windows[i]);
  std::vector<std::pair<double, LogTyres>> points;
  for (const double friction : kFrictions) {
    for (const double stiffness : kStiffnesses) {
      const LogTyres at{std::log(friction), std::log(stiffness)};
      if (const auto sums = sums_on_tyres(some, plants, at)) points.emplace_back(sums->cost(), at);
    }
  }
  std::ranges::sort(points, {}, [](const auto& point) { return point.first; });
  std::vector<LogTyres> starts;
  for (std::size_t i = 0; i < std::min(points.size(), kMostStarts); ++i) {
    starts.push_back(points[i].second);
  }
  return starts;
}

/// The tyres with the least cost, searched from `from`; what is not free stays there. None: the windows
/// cannot be replayed there.
std::optional<Fit> fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                       const LogTyres& from) {
  constexpr int kMostRounds = 8;
  constexpr double kSameCost = 1e-5;  // of a cost, per error
  const auto first = sums_on_tyres(windows, plants, from);
  if (!first) return std::nullopt;
  Fit best{.at = from, .weights = first->weights(), .cost = first->cost()};
  for (int round = 0; round < kMostRounds && !best.converged; ++round) {
    Fit next = best;
    ceres::Problem problem = problem_of(windows, plants, best.weights, is_free, next.at);
    silence_ceres();
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 30;
    options.function_tolerance = 1e-5;
    options.parameter_tolerance = 1e-5;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    next.stop_reason = summary.message;
    const auto sums = sums_on_tyres(windows, plants, next.at);
    if (!summary.IsSolutionUsable() || !sums) return next;
    next.cost = sums->cost();
    next.weights = sums->weights();
    next.converged = summary.termination_type == ceres::CONVERGENCE &&
                     std::abs(best.cost - next.cost) <= kSameCost * problem.NumResiduals();
    best = std::move(next);
  }
  return best;
}

/// What a window says of the tyres at the fit: J'J and J'e, of the free parameters.
struct WindowInformation {
  Eigen::Matrix2d information;
  Eigen::Vector2d score;
};

std::optional<WindowInformation> information_of(const ReplayedWindow& window, const Plants& plants,
                                                const IsFree& is_free, const Fit& fit) {
  const TyreCost cost(window, plants, fit.weights);
  const auto count = rows_of(window.channels);
  Eigen::VectorXd errors(count);
  Eigen::MatrixXd by(count, 2);
  const double* at[] = {&fit.at[kFriction], &fit.at[kCornering]};
  double* columns[] = {by.col(kFriction).data(), by.col(kCornering).data()};
  if (!cost.Evaluate(at, errors.data(), columns)) return std::nullopt;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    if (!is_free[awmr::at(p)]) by.col(p).setZero();
  }
  return WindowInformation{by.transpose() * by, by.transpose() * errors};
}

/// Standard errors of the logarithms, by the jackknife over windows; none for what is held, and where all
/// hangs on one window.
std::array<std::optional<double>, 2> log_errors(const Windows& windows, const Plants& plants,
                                                const IsFree& is_free, const Fit& fit) {
  std::vector<WindowInformation> each;
  Eigen::Matrix2d held = Eigen::Matrix2d::Zero();
  for (const Eigen::Index p : {kFriction, kCornering}) {
    if (!is_free[at(p)]) held(p, p) = 1.0;
  }
  Eigen::Matrix2d information = held;
  for (const ReplayedWindow* window : windows) {
    const auto one = information_of(*window, plants, is_free, fit);
    if (!one) return {};
    information += one->information;
    each.push_back(*one);
  }
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();
  for (const WindowInformation& one : each) {
    const Eigen::LLT<Eigen::Matrix2d> without(information - one.information);
    if (without.info() != Eigen::Success) return {};
    variance += without.solve(one.score).cwiseAbs2();
  }
  const auto count = static_cast<double>(windows.size());
  variance *= (count - 1.0) / count;
  std::array<std::optional<double>, 2> of;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    const bool is_known = is_free[at(p)] && variance[p] > 0.0 && std::isfinite(variance[p]);
    if (is_known) of[at(p)] = std::sqrt(variance[p]);
  }
  return of;
}

/// Half of the 95 % interval, in standard errors.
double t_quantile(double degrees_of_freedom) {
  return students_t_quantile(0.975, degrees_of_freedom);
}

bool is_inside(Eigen::Index parameter, double log_value) {
  constexpr double kNear = 1e-3;
  const Interval range = range_of(parameter);
  return log_value > range.lo + kNear && log_value < range.hi - kNear;
}

Estimate estimate_of(double log_value, double log_error, std::size_t windows) {
  const double value = std::exp(log_value);
  const double factor = std::exp(t_quantile(static_cast<double>(windows) - 2.0) * log_error);
  return {.value = value,
          .std_error = value * log_error,
          .ci95 = Interval{value / factor, value * factor},
          .source = Source::kFitted,
          .method = "four-wheel"};
}

/// Whether a window has a turn by the sides' forces, or by steering.
struct Turns {
  bool by_sides = false;
  bool by_steering = false;
};

Turns turns_in(const LogWindow& rows, const Plant<double>& plant) {
  constexpr double kLittleAngle_rad = 0.02;
  constexpr double kLittleForce = 0.02;
  constexpr double kMuchMore = 3.0;
  const DrivingLog& log = *rows.log;
  double by_sides = 0.0;  // sums of squares of moments over F_max
  double by_steering = 0.0;
  double angles = 0.0;
  double apart = 0.0;
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const double angle = log.driving_steering_rad()[row];
    const double difference = log.force_right[row] - log.force_left[row];
    const double steered =
        plant.front_axle_m * (log.force_left[row] + log.force_right[row]) * std::sin(angle);
    by_sides += std::pow(2.0 * plant.half_track_m * difference, 2);
    by_steering += steered * steered;
    angles += angle * angle;
    apart += difference * difference;
  }
  const auto count = static_cast<double>(rows.end - rows.begin);
  const bool steers = angles > count * kLittleAngle_rad * kLittleAngle_rad;
  const bool pushes = apart > count * kLittleForce * kLittleForce;
  return {.by_sides = pushes && by_sides > kMuchMore * by_steering,
          .by_steering = steers && by_steering >= kMuchMore * by_sides};
}

Finding finding(const DrivingLog& log, Severity severity, const char* code, std::string message) {
  return {log.file, 0, severity, code, std::move(message)};
}

/// What the windows lack to show tyres; none: nothing.
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
  const bool enough = windows.size() >= kFewestTyreWindows && by_sides >= kFewestTurns &&
                      (!steers || by_steering >= kFewestTurns);
  if (enough) return std::nullopt;
  return finding(
      log, Severity::kError, "tyres-need-turns",
      fmt::format(
          "tyres are fitted to at least {} windows of {:g} s, {} of them with each kind of turn; "
          "these logs have {}, {} with turns by left and right wheel forces{}; a turn by both at "
          "once counts for neither. Record a drive that turns {}",
          kFewestTyreWindows, kWindow_s, kFewestTurns, windows.size(), by_sides,
          steers ? fmt::format(" and {} with steered ones", by_steering) : "",
          steers ? "by the forces with straight wheels, then by steering with equal forces, "
                   "and coasts while it steers"
                 : "by the forces at several speeds"));
}

/// Squared errors of both plants on windows that the tyres were not fitted to.
struct HeldOutSums {
  ErrorSums model;
  ErrorSums four_wheel;
  std::vector<std::pair<ErrorSums, ErrorSums>> by_window;  ///< model, four wheels
};

/// All windows, or kMostWindows over the whole of the logs: more make the fit long and little better.
Windows evenly_chosen(const std::vector<ReplayedWindow>& all) {
  constexpr std::size_t kMostWindows = 60;
  const std::size_t count = std::min(all.size(), kMostWindows);
  Windows windows;
  for (std::size_t i = 0; i < count; ++i) windows.push_back(&all[i * all.size() / count]);
  return windows;
}

/// The fit of what the windows show: a parameter that they do not is held at its default.
struct ShownFit {
  Fit fit;
  IsFree is_free{true, true};
  std::array<std::optional<double>, 2> errors;
};

/// Cross-validation over every other window.
std::optional<HeldOutSums> held_out(const Windows& windows, const Plants& plants,
                                    const ShownFit& shown) {
  HeldOutSums sums;
  for (const std::size_t fold : {0U, 1U}) {
    Windows fitted;
    Windows rest;
    for (std::size_t i = 0; i < windows.size(); ++i)
      (i % 2 == fold ? fitted : rest).push_back(windows[i]);
    const auto tyres = fit(fitted, plants, shown.is_free, shown.fit.at);
    if (!tyres) return std::nullopt;
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

/// The plant that the interval of the mean of D_w prefers; none: it holds 0.
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
  const double half = t_quantile(count - 1.0) *
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
    text += fmt::format("{}{} {:.3g} on tyres and {:.3g} on the model", text.empty() ? "" : ", ",
                        error.channel, error.four_wheel_rms, error.model_rms);
  }
  const std::string verdict = !tyres.better ? "neither plant predicts better"
                              : *tyres.better == PlantKind::kFourWheel
                                  ? "four wheels on tyres predict better than the model"
                                  : "the model predicts better than four wheels on tyres";
  return fmt::format(
      "over {} windows of {:g} s that the tyres were not fitted to, {} (root mean square "
      "errors: {})",
      tyres.windows, kWindow_s, verdict, text);
}

std::vector<ReplayedWindow> windows_in(const std::vector<DrivingLog>& logs,
                                       const std::vector<ReplayedLog>& replayed) {
  std::vector<ReplayedWindow> windows;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (const LogWindow& rows : windows_of(logs[i], kWindow_s)) {
      ReplayedWindow window{&replayed[i], rows, replayed[i].state_before(rows)};
      for (std::size_t row = rows.begin; row < rows.end; ++row) {
        if (!counts(rows, row)) continue;
        each_measurement(rows, row, [&](LogChannel c, double) { window.channels.push_back(c); });
      }
      if (!window.channels.empty()) windows.push_back(std::move(window));
    }
  }
  return windows;
}

/// Of the free parameters that the windows do not show, that with the largest error; none: all are shown.
std::optional<Eigen::Index> least_shown(const ShownFit& shown) {
  std::optional<Eigen::Index> worst;
  double largest = 0.0;
  for (const Eigen::Index p : {kFriction, kCornering}) {
    if (!shown.is_free[at(p)]) continue;
    const double error = shown.errors[at(p)].value_or(std::numeric_limits<double>::infinity());
    const bool is_shown = error <= kLargestLogError && is_inside(p, shown.fit.at[p]);
    if (is_shown || error <= largest) continue;
    worst = p;
    largest = error;
  }
  return worst;
}

/// The best of the fits from these starts; none: the windows can be replayed from none of them.
std::optional<Fit> best_fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                            const std::vector<LogTyres>& starts) {
  std::optional<Fit> best;
  for (const LogTyres& start : starts) {
    auto found = fit(windows, plants, is_free, start);
    if (found && (!best || found->cost < best->cost)) best = std::move(found);
  }
  return best;
}

std::optional<ShownFit> fit_what_is_shown(const Windows& windows, const Plants& plants) {
  std::vector<LogTyres> starts = starts_of(windows, plants);
  ShownFit shown;
  while (shown.is_free[kFriction] || shown.is_free[kCornering]) {
    const auto found = best_fit(windows, plants, shown.is_free, starts);
    if (!found) return std::nullopt;
    shown.fit = *found;
    if (!found->converged) return shown;
    shown.errors = log_errors(windows, plants, shown.is_free, *found);
    const auto worst = least_shown(shown);
    if (!worst) return shown;
    shown.is_free[at(*worst)] = false;
    starts = {found->at};
    starts.front()[*worst] = default_tyres()[*worst];
  }
  return shown;
}

/// The intervals' numbers, or a finding that says that the parameter is held.
std::optional<Estimate> estimate_or_held(const ShownFit& shown, Eigen::Index p, std::size_t windows,
                                         const DrivingLog& log, std::vector<Finding>& findings) {
  if (shown.is_free[at(p)]) return estimate_of(shown.fit.at[p], *shown.errors[at(p)], windows);
  const char* name = p == kFriction ? "friction" : "cornering stiffness";
  const char* trial = p == kFriction
                          ? "turn so that the tyres slide: tighter, faster, with more force"
                          : "steer gently at speed, and while coasting";
  findings.push_back(
      finding(log, Severity::kWarning, "tyres-not-shown",
              fmt::format("the logs do not show the tyres' {}, which is held at {:g}: {}", name,
                          std::exp(default_tyres()[p]), trial)));
  return std::nullopt;
}

Status check_vehicle(const Model& model) {
  if (model.vehicle.driven_wheels() == 4) return {};
  return input_error(
      option_text("tyres"),
      fmt::format("the four-wheel plant drives all wheels, a vehicle of drive \"{}\" does "
                  "not",
                  name_in(kDriveNames, model.vehicle.drive)));
}

}  // namespace

Result<std::optional<TyreFit>> fit_tyres(const std::vector<DrivingLog>& logs, const Model& model,
                                         std::vector<Finding>& findings) {
  AWMR_RETURN_IF_ERROR(check_vehicle(model));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_RETURN_IF_ERROR(check_replay(plant, model.file));
  const DrivingLog& first = logs.front();
  const auto refuse = [&](const char* code, std::string why) {
    findings.push_back(finding(first, Severity::kError, code, std::move(why)));
    return std::optional<TyreFit>();
  };
  const Plants plants(plant);
  std::vector<ReplayedLog> replayed;
  for (const DrivingLog& log : logs) {
    replayed.emplace_back(log, plant, model.vehicle.motor_time_constant_s.value_or(0.0));
  }
  const std::vector<ReplayedWindow> all = windows_in(logs, replayed);
  if (auto missing = missing_turns(all, first, model.vehicle, plant)) {
    findings.push_back(*std::move(missing));
    return std::optional<TyreFit>();
  }
  const Windows windows = evenly_chosen(all);
  const auto shown = fit_what_is_shown(windows, plants);
  if (!shown)
    return refuse("tyres-not-converged", "no step is short enough to replay these logs on tyres");
  if (!shown->is_free[kFriction] && !shown->is_free[kCornering]) {
    return refuse(
        "tyres-not-shown",
        "the logs show neither the friction nor the cornering stiffness of the tyres: record "
        "tighter and faster turns of both kinds");
  }
  if (!shown->fit.converged) {
    return refuse("tyres-not-converged",
                  "the fit of the tyres did not converge: " + shown->fit.stop_reason);
  }
  const auto sums = held_out(windows, plants, *shown);
  if (!sums)
    return refuse("tyres-not-converged", "the tyres cannot be fitted to every other window");
  TyreFit tyres{
      .tyres = tyres_at(shown->fit.at),
      .friction = estimate_or_held(*shown, kFriction, windows.size(), first, findings),
      .cornering_per_rad = estimate_or_held(*shown, kCornering, windows.size(), first, findings),
      .windows = static_cast<int>(windows.size()),
      .held_out = errors_by_channel(*sums),
      .better = better_plant(*sums)};
  if (model[ParameterId::kInertiaNorm].source == Source::kFitted) {
    findings.push_back(finding(
        first, Severity::kWarning, "inertia-of-logs",
        "I'z of the model was fitted to logs on the 3-DOF plant, where it may hold moments of the "
        "tyres: a model from tables, whose I'z is m' Iz/m, suits the four-wheel plant better"));
  }
  findings.push_back(finding(first, Severity::kNote, "plants-compared", comparison_text(tyres)));
  return std::optional(std::move(tyres));
}

}  // namespace awmr
