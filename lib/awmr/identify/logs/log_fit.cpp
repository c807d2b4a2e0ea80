#include "awmr/identify/logs/log_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "awmr/core/random.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/uncertainty/diagnostics.h"
#include "awmr/identify/logs/log_window.h"
#include "awmr/identify/tables/robust.h"
#include "awmr/identify/tables/steady_fit.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

constexpr double kWindow_s = 10.0;
/// A coordinate whose standard error is this share of its scale is not shown by the data: a factor
/// of 2.7 either way at 95 % for a logarithm, 1 for an exponent.
constexpr double kUnknown = 0.5;
/// Pull of every coordinate towards its start, in its scale: so weak that data of any use outweigh
/// it, and what no data show stays put.
constexpr double kPriorStd = 5.0;
constexpr double kFine = 1e-9;  ///< of the cost: a millionth of a standard error squared and less
constexpr double kOnePercent = 2.576;  ///< two-sided, normal

/// Loss::k... as the square root of its weight at a standardised residual.
double sqrt_weight(Loss loss, double r) {
  const double size = std::abs(r);
  switch (loss) {
    case Loss::kSquared:
      return 1.0;
    case Loss::kHuber:
      return size <= 1.345 ? 1.0 : std::sqrt(1.345 / size);
    case Loss::kCauchy:
      return 1.0 / std::sqrt(1.0 + r * r / (2.385 * 2.385));
    case Loss::kTukey:
      return size < 4.685 ? 1.0 - r * r / (4.685 * 4.685) : 0.0;
  }
  return 1.0;
}

/// Evaluates every window before Ceres asks for any: in parallel, each on its own, so that the
/// result does not depend on the number of threads.
class Evaluator : public ceres::EvaluationCallback {
 public:
  Evaluator(const LogModel& model, const std::vector<double>& coordinates,
            std::vector<FitWindow*> windows, int threads)
      : model_(model), coordinates_(coordinates), windows_(std::move(windows)), threads_(threads) {}

  void PrepareForEvaluation(bool jacobians, bool new_point) final {
    if (!new_point && (!jacobians || has_jacobians_)) return;
    has_jacobians_ = jacobians;
    run(jacobians);
  }

  void run(bool jacobians) {
    finite_.assign(windows_.size(), 1);
    const auto work = [&](std::size_t first, std::size_t stride) {
      for (std::size_t i = first; i < windows_.size(); i += stride) {
        finite_[i] = evaluate(model_, coordinates_.data(), jacobians, *windows_[i]) ? 1 : 0;
      }
    };
    const std::size_t available = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t count =
        std::min(windows_.size(), threads_ > 0 ? static_cast<std::size_t>(threads_) : available);
    std::vector<std::thread> pool;
    for (std::size_t t = 1; t < count; ++t) pool.emplace_back(work, t, count);
    work(0, std::max<std::size_t>(1, count));
    for (std::thread& thread : pool) thread.join();
  }

  bool finite(std::size_t window) const { return finite_[window] != 0; }
  const FitWindow& window(std::size_t i) const { return *windows_[i]; }

 private:
  const LogModel& model_;
  const std::vector<double>& coordinates_;
  std::vector<FitWindow*> windows_;
  int threads_;
  bool has_jacobians_ = false;
  std::vector<char> finite_;
};

/// Hands Ceres what the Evaluator made.
class WindowCost : public ceres::CostFunction {
 public:
  WindowCost(const Evaluator& evaluator, std::size_t index, int quantities, int starts)
      : evaluator_(evaluator), index_(index), quantities_(quantities), starts_(starts) {
    mutable_parameter_block_sizes()->push_back(quantities);
    mutable_parameter_block_sizes()->push_back(starts);
    set_num_residuals(static_cast<int>(evaluator.window(index).samples.size()) + starts);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const final {
    if (!evaluator_.finite(index_)) return false;
    const FitWindow& window = evaluator_.window(index_);
    const Eigen::Index rows = window.residuals.size();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = window.residuals;
    if (!jacobians) return true;
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (jacobians[0]) {
      Eigen::Map<Rows>(jacobians[0], rows, quantities_) = window.jacobian.leftCols(quantities_);
    }
    if (jacobians[1]) {
      Eigen::Map<Rows>(jacobians[1], rows, starts_) = window.jacobian.rightCols(starts_);
    }
    return true;
  }

 private:
  const Evaluator& evaluator_;
  std::size_t index_;
  int quantities_;
  int starts_;
};

/// (x_i - start_i) / (kPriorStd scale_i)
class PriorCost : public ceres::CostFunction {
 public:
  PriorCost(std::vector<double> centre, std::vector<double> std)
      : centre_(std::move(centre)), std_(std::move(std)) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(centre_.size()));
    set_num_residuals(static_cast<int>(centre_.size()));
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const final {
    for (std::size_t i = 0; i < centre_.size(); ++i) {
      residuals[i] = (x[0][i] - centre_[i]) / std_[i];
      if (!jacobians || !jacobians[0]) continue;
      for (std::size_t j = 0; j < centre_.size(); ++j) {
        jacobians[0][i * centre_.size() + j] = i == j ? 1.0 / std_[i] : 0.0;
      }
    }
    return true;
  }

 private:
  std::vector<double> centre_;
  std::vector<double> std_;
};

struct Bounds {
  double lo;
  double hi;
};

/// Collects fit_logs().
class LogFitter {
 public:
  LogFitter(const std::vector<DrivingLog>& logs, const LogFitOptions& options)
      : logs_(logs), options_(options) {
    model_.vehicle = options.vehicle;
    model_.held = options.start;
    fine_step_s_ = replay_step_s(plant_at(options.vehicle, options.start));
    model_.longest_step_s = 2.0 * fine_step_s_;
    list_quantities();
    list_windows();
    first_noise();
  }

  LogFit run() {
    if (!choose_start()) return std::move(fit_);
    refine();
    conclude();
    return std::move(fit_);
  }

 private:
  void list_quantities() {
    for (const ParameterId id : options_.free) {
      const bool term = info(id).term;
      const bool exponent = id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
      FreeQuantity quantity;
      quantity.id = id;
      quantity.logarithmic = !term && !exponent;
      // A term is measured against the force it is a part of; an exponent against 1.
      if (term) quantity.scale = 0.2;
      model_.quantities.push_back(quantity);
    }
    if (options_.delay) {
      model_.quantities.push_back({.kind = FreeQuantity::Kind::kDelay, .scale = 0.1});
    }
    for (const LogChannel channel : options_.biases) {
      model_.quantities.push_back(
          {.kind = FreeQuantity::Kind::kBias, .channel = channel, .scale = 1.0});
    }
    for (const FreeQuantity& q : model_.quantities) {
      double value = 0.0;
      if (q.kind == FreeQuantity::Kind::kParameter) value = options_.start.at(q.id);
      coordinates_.push_back(q.logarithmic ? std::log(value) : value);
    }
    centre_ = coordinates_;
  }

  /// The parts of the initial state that anything measured depends on.
  void list_start_components() {
    bool position = false;
    bool heading = false;
    bool servo = false;
    for (const DrivingLog& log : logs_) {
      position = position || log[LogChannel::kX] || log[LogChannel::kY];
      heading = heading || log[LogChannel::kHeading];
      servo = servo || log.steering_command_rad;
    }
    if (position) {
      model_.start.push_back({&State<double>::x_m, 100.0});
      model_.start.push_back({&State<double>::y_m, 100.0});
    }
    if (position || heading) model_.start.push_back({&State<double>::psi_rad, 10.0});
    model_.start.push_back({&State<double>::u_mps, 1.0});
    model_.start.push_back({&State<double>::v_mps, 1.0});
    model_.start.push_back({&State<double>::r_radps, 1.0});
    if (servo) model_.start.push_back({&State<double>::steering_rad, 0.2});
  }

  void list_windows() {
    list_start_components();
    for (const DrivingLog& log : logs_) signals_.emplace_back(log);
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      for (const LogWindow& window : windows_of(logs_[i], kWindow_s)) {
        FitWindow fit;
        fit.window = window;
        fit.signals = &signals_[i];
        list_samples(fit);
        fit.assumed = measured_start(window);
        if (!fit.samples.empty()) windows_.push_back(std::move(fit));
      }
    }
    // In one piece and in order: Ceres eliminates blocks by their address, which is then the same
    // order in every run.
    starts_.resize(windows_.size() * model_.start.size());
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      windows_[i].start = &starts_[i * model_.start.size()];
      reset_start(windows_[i]);
    }
  }

  static void list_samples(FitWindow& fit) {
    const DrivingLog& log = *fit.window.log;
    std::array<std::optional<double>, kChannelCount> previous_s;
    for (std::size_t row = fit.window.begin; row < fit.window.end; ++row) {
      for (const LogChannel channel : kChannels) {
        if (!log[channel] || !log[channel]->fresh[row]) continue;
        // An angle that drives the model is no measurement of it.
        if (channel == LogChannel::kSteering && !log.steering_command_rad) continue;
        auto& before_s = previous_s[static_cast<std::size_t>(channel)];
        fit.samples.push_back({row, channel, 1.0, before_s ? log.t_s[row] - *before_s : 0.0});
        before_s = log.t_s[row];
      }
    }
  }

  void reset_start(FitWindow& window) const {
    for (std::size_t i = 0; i < model_.start.size(); ++i) {
      window.start[i] = window.assumed.*(model_.start[i].member);
    }
  }

  /// The noise of a smooth signal shows in its second differences: sum d^2 / (6 (n - 2)).
  void first_noise() {
    std::map<LogChannel, std::pair<double, int>> sums;
    for (const FitWindow& window : windows_) {
      std::array<std::vector<double>, kChannelCount> values;
      for (const Sample& sample : window.samples) {
        std::vector<double>& v = values[static_cast<std::size_t>(sample.channel)];
        v.push_back((*window.window.log)[sample.channel]->value[sample.row]);
        auto& [sum, count] = sums[sample.channel];
        ++model_.noise[sample.channel].count;
        if (v.size() < 3) continue;
        const double d = v[v.size() - 1] - 2.0 * v[v.size() - 2] + v[v.size() - 3];
        sum += d * d;
        ++count;
      }
    }
    for (auto& [channel, noise] : model_.noise) {
      const auto& [sum, count] = sums[channel];
      noise.std = count > 0 ? std::sqrt(sum / (6.0 * count)) : 1.0;
      // Noise-free data still have to weigh something.
      noise.std = std::max(noise.std, 1e-9);
      noise.sensor_std = noise.std;
    }
  }

  Bounds bounds_of(std::size_t i) const {
    const FreeQuantity& q = model_.quantities[i];
    if (q.kind == FreeQuantity::Kind::kDelay) return {0.0, 1.0};
    if (q.kind == FreeQuantity::Kind::kBias) return {-1e6, 1e6};
    if (q.id == ParameterId::kSurgeBeta || q.id == ParameterId::kYawBeta) {
      const Interval range = q.id == ParameterId::kSurgeBeta ? options_.vehicle.surge_beta_range
                                                             : options_.vehicle.yaw_beta_range;
      return {range.lo, range.hi};
    }
    if (!q.logarithmic) return {0.0, 1e6};
    return {centre_[i] - 10.0, centre_[i] + 10.0};
  }

  struct Solved {
    double cost = std::numeric_limits<double>::infinity();
    bool converged = false;
    bool usable = false;
    std::string stop_reason;
  };

  Solved solve(const std::vector<FitWindow*>& windows, double function_tolerance) {
    Evaluator evaluator(model_, coordinates_, windows, options_.threads);
    ceres::Problem::Options problem_options;
    problem_options.evaluation_callback = &evaluator;
    ceres::Problem problem(problem_options);
    const int n = static_cast<int>(coordinates_.size());
    const int k = static_cast<int>(model_.start.size());
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (std::size_t i = 0; i < windows.size(); ++i) {
      problem.AddResidualBlock(new WindowCost(evaluator, i, n, k), nullptr, coordinates_.data(),
                               windows[i]->start);
      ordering->AddElementToGroup(windows[i]->start, 0);
    }
    ordering->AddElementToGroup(coordinates_.data(), 1);
    std::vector<double> stds;
    for (const FreeQuantity& q : model_.quantities) stds.push_back(kPriorStd * q.scale);
    problem.AddResidualBlock(new PriorCost(centre_, stds), nullptr, coordinates_.data());
    for (int i = 0; i < n; ++i) {
      const Bounds bounds = bounds_of(static_cast<std::size_t>(i));
      coordinates_[static_cast<std::size_t>(i)] =
          std::clamp(coordinates_[static_cast<std::size_t>(i)], bounds.lo, bounds.hi);
      problem.SetParameterLowerBound(coordinates_.data(), i, bounds.lo);
      problem.SetParameterUpperBound(coordinates_.data(), i, bounds.hi);
    }
    silence_ceres();
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering = ordering;
    options.max_num_iterations = 100;
    options.function_tolerance = function_tolerance;
    options.gradient_tolerance = 1e-12;
    options.parameter_tolerance = 1e-9;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return {summary.final_cost, converged(summary), summary.IsSolutionUsable(),
            stop_reason(summary)};
  }

  std::vector<FitWindow*> all_windows() {
    std::vector<FitWindow*> windows;
    for (FitWindow& window : windows_) windows.push_back(&window);
    return windows;
  }

  /// At most half a minute's worth, spread over all logs: enough to tell a good start from a bad
  /// one.
  std::vector<FitWindow*> some_windows() {
    constexpr std::size_t kMost = 3;
    std::vector<FitWindow*> windows;
    const std::size_t count = std::min(kMost, windows_.size());
    for (std::size_t i = 0; i < count; ++i) {
      windows.push_back(&windows_[i * windows_.size() / count]);
    }
    return windows;
  }

  std::vector<double> values_at(const std::vector<double>& coordinates) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      values.push_back(model_.quantities[i].value(coordinates[i]));
    }
    return values;
  }

  /// A draw about the centre for each guessed quantity: a factor up to e^2 for a logarithm,
  /// anywhere in [0.3, 1.3] for an exponent.
  std::vector<double> draw(Random& random) const {
    std::vector<double> start = centre_;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const FreeQuantity& q = model_.quantities[i];
      const bool guessed = q.kind == FreeQuantity::Kind::kParameter &&
                           std::find(options_.guessed.begin(), options_.guessed.end(), q.id) !=
                               options_.guessed.end();
      const double u = random.uniform();
      if (!guessed) continue;
      if (q.logarithmic) {
        start[i] += 4.0 * u - 2.0;
      } else if (!info(q.id).term) {
        const Bounds bounds = bounds_of(i);
        start[i] = std::clamp(0.3 + u, bounds.lo, bounds.hi);
      }
    }
    return start;
  }

  /// From the tables: one start. From guesses: several, on some windows each; the best goes on.
  bool choose_start() {
    if (windows_.empty() || coordinates_.empty()) {
      fit_.report.stop_reason = "nothing measured, or nothing asked for";
      return false;
    }
    if (options_.guessed.empty()) {
      fit_.report.starts.push_back({values_at(centre_), 0.0, true, "from the other trials"});
      return true;
    }
    constexpr double kRough = 1e-4;
    Random random(options_.seed, 1);
    const std::vector<FitWindow*> windows = some_windows();
    std::vector<double> best;
    double least = std::numeric_limits<double>::infinity();
    std::size_t chosen = 0;
    for (int i = 0; i <= options_.starts; ++i) {
      coordinates_ = i == 0 ? centre_ : draw(random);
      const std::vector<double> from = coordinates_;
      for (FitWindow* window : windows) reset_start(*window);
      const Solved solved = solve(windows, kRough);
      fit_.report.starts.push_back(
          {values_at(from), solved.cost, false, solved.stop_reason.substr(0, 60)});
      if (!solved.usable || !(solved.cost < least)) continue;
      least = solved.cost;
      best = coordinates_;
      chosen = fit_.report.starts.size() - 1;
    }
    if (best.empty()) {
      fit_.report.stop_reason = "no start led anywhere: every one left the finite numbers";
      return false;
    }
    fit_.report.starts[chosen].chosen = true;
    coordinates_ = best;
    for (FitWindow& window : windows_) reset_start(window);
    return true;
  }

  /// Noise levels from the residuals of the last solution: standard deviation (by the median under
  /// a robust loss), correlation by its first lag.
  void update_noise() {
    std::map<LogChannel, std::vector<double>> all;
    std::map<LogChannel, std::array<double, 3>> lag;  // sum e e', sum e^2, sum dt
    for (const FitWindow& window : windows_) {
      std::array<std::optional<double>, kChannelCount> previous;
      for (std::size_t i = 0; i < window.samples.size(); ++i) {
        const Sample& sample = window.samples[i];
        const double e = window.raw(static_cast<Eigen::Index>(i));
        all[sample.channel].push_back(e);
        auto& before = previous[static_cast<std::size_t>(sample.channel)];
        auto& [products, squares, spans] = lag[sample.channel];
        if (before) {
          products += e * *before;
          squares += 0.5 * (e * e + *before * *before);
          spans += sample.since_s;
        }
        before = e;
      }
    }
    const double spent =
        static_cast<double>(coordinates_.size() + model_.start.size() * windows_.size());
    double total = 0.0;
    for (const auto& [channel, e] : all) total += static_cast<double>(e.size());
    for (auto& [channel, noise] : model_.noise) {
      const std::vector<double>& e = all[channel];
      const Eigen::Map<const Eigen::VectorXd> v(e.data(), static_cast<Eigen::Index>(e.size()));
      const double n = static_cast<double>(e.size());
      const double free = n * std::max(0.1, 1.0 - spent / total);
      noise.std =
          options_.loss == Loss::kSquared ? std::sqrt(v.squaredNorm() / free) : median_scale(v);
      noise.std = std::max(noise.std, 1e-9);
      const auto& [products, squares, spans] = lag[channel];
      const double rho = squares > 0.0 ? products / squares : 0.0;
      // Correlation of no consequence (below a tenth) is left alone.
      const bool autocorrelated = rho * std::sqrt(n) > kOnePercent && rho > 0.1;
      noise.step_s = spans / n;
      noise.correlation_s = autocorrelated ? -(spans / n) / std::log(std::min(rho, 0.999)) : 0.0;
    }
    if (options_.loss == Loss::kSquared) return;
    for (FitWindow& window : windows_) {
      for (std::size_t i = 0; i < window.samples.size(); ++i) {
        Sample& sample = window.samples[i];
        const double r =
            window.raw(static_cast<Eigen::Index>(i)) / model_.noise[sample.channel].std;
        sample.weight = sqrt_weight(options_.loss, r);
      }
    }
  }

  void evaluate_all(bool jacobians) {
    Evaluator(model_, coordinates_, all_windows(), options_.threads).run(jacobians);
  }

  /// The fit and its noise levels settle together in a few rounds; the search for a start and the
  /// first round take steps of twice the length.
  void refine() {
    constexpr int kRounds = 6;
    constexpr double kSettled = 0.01;
    constexpr double kMiddling = 1e-6;
    for (int round = 0; round < kRounds; ++round) {
      solved_ = solve(all_windows(), kMiddling);
      model_.longest_step_s = fine_step_s_;
      evaluate_all(false);
      const auto before = model_.noise;
      update_noise();
      double change = 0.0;
      for (const auto& [channel, noise] : model_.noise) {
        const ChannelNoise& old = before.at(channel);
        change = std::max(change, std::abs(noise.std / old.std - 1.0));
        if (noise.correlation_s > 0.0 || old.correlation_s > 0.0) {
          change = std::max(change, std::abs(noise.correlation_s - old.correlation_s) /
                                        std::max(noise.correlation_s, old.correlation_s));
        }
      }
      if (change < kSettled && round > 0) break;
    }
    solved_ = solve(all_windows(), kFine);
    evaluate_all(true);
  }

  /// Information on the quantities with each window's start eliminated, S = H_tt - H_ts H_ss^-1
  /// H_st, and the scores of blocks of about `block_s` for the bootstrap.
  Eigen::MatrixXd information(double block_s, std::vector<Eigen::VectorXd>* scores) {
    const auto n = static_cast<Eigen::Index>(coordinates_.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    for (const FitWindow& window : windows_) {
      const auto k = static_cast<Eigen::Index>(model_.start.size());
      const Eigen::MatrixXd jt = window.jacobian.leftCols(n);
      const Eigen::MatrixXd js = window.jacobian.rightCols(k);
      const Eigen::MatrixXd inner = (js.transpose() * js).ldlt().solve(js.transpose() * jt);
      const Eigen::MatrixXd projected = jt - js * inner;
      sum += projected.transpose() * jt;
      if (!scores) continue;
      double from_s = window.window.log->t_s[window.window.begin];
      Eigen::VectorXd score = Eigen::VectorXd::Zero(n);
      for (std::size_t i = 0; i < window.samples.size(); ++i) {
        const double t_s = window.window.log->t_s[window.samples[i].row];
        if (t_s - from_s >= block_s) {
          scores->push_back(score);
          score.setZero();
          from_s = t_s;
        }
        const auto at = static_cast<Eigen::Index>(i);
        score += projected.row(at).transpose() * window.residuals(at);
      }
      scores->push_back(score);
    }
    return 0.5 * (sum + sum.transpose());
  }

  /// Directions of the scaled coordinates that the data leave open: their names, in words.
  void find_unknown(const Eigen::MatrixXd& info_matrix) {
    const auto n = static_cast<Eigen::Index>(coordinates_.size());
    Eigen::VectorXd scale(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      scale(i) = model_.quantities[static_cast<std::size_t>(i)].scale;
    }
    const Eigen::MatrixXd scaled = scale.asDiagonal() * info_matrix * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    const Eigen::VectorXd& values = eigen.eigenvalues();
    const double largest = values(n - 1);
    fit_.report.condition_number =
        values(0) > 0.0 ? std::sqrt(largest / values(0)) : std::numeric_limits<double>::infinity();
    constexpr double kNull = 1e-12;
    fit_.identifiable.assign(static_cast<std::size_t>(n), true);
    fit_.why.assign(static_cast<std::size_t>(n), "");
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
    int rank = 0;
    for (Eigen::Index d = 0; d < n; ++d) {
      const bool null = !(values(d) > kNull * largest);
      const double std =
          null ? std::numeric_limits<double>::infinity() : 1.0 / std::sqrt(values(d));
      const Eigen::VectorXd direction = eigen.eigenvectors().col(d);
      if (std < kUnknown) {
        inverse += direction * direction.transpose() / values(d);
        ++rank;
        continue;
      }
      mark(direction, std);
    }
    fit_.report.rank = rank;
    fit_.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
    // Unknown enough on its own, though in no direction of its own.
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double std = std::sqrt(fit_.covariance(i, i)) / scale(i);
      if (fit_.identifiable[at] && std > kUnknown) {
        fit_.identifiable[at] = false;
        fit_.why[at] = "these logs leave it open: " + width(std);
      }
    }
  }

  /// A coordinate that the search left at the end of its range was stopped there, not found; and an
  /// exponent without its factor says nothing.
  void refuse_stopped() {
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const FreeQuantity& q = model_.quantities[i];
      const Bounds bounds = bounds_of(i);
      const bool term_at_zero = q.kind == FreeQuantity::Kind::kParameter && info(q.id).term &&
                                coordinates_[i] == bounds.lo;
      const bool stopped = coordinates_[i] <= bounds.lo || coordinates_[i] >= bounds.hi;
      if (!stopped || term_at_zero || q.kind == FreeQuantity::Kind::kDelay) continue;
      fit_.identifiable[i] = false;
      fit_.why[i] =
          fmt::format("the search ended at the end of its range, {:.4g}", q.value(coordinates_[i]));
    }
    const auto place = [&](ParameterId id) {
      for (std::size_t i = 0; i < model_.quantities.size(); ++i) {
        const FreeQuantity& q = model_.quantities[i];
        if (q.kind == FreeQuantity::Kind::kParameter && q.id == id) return i;
      }
      return model_.quantities.size();
    };
    for (const auto& [alpha, beta] : {std::pair(ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta),
                                      std::pair(ParameterId::kYawAlpha, ParameterId::kYawBeta)}) {
      const std::size_t a = place(alpha);
      const std::size_t b = place(beta);
      if (a == model_.quantities.size() || b == model_.quantities.size()) continue;
      if (fit_.identifiable[a] || !fit_.identifiable[b]) continue;
      fit_.identifiable[b] = false;
      fit_.why[b] =
          fmt::format("{} is open, and an exponent says nothing without it", info(alpha).name);
    }
  }

  static std::string width(double std) {
    if (!std::isfinite(std) || std > 1e3) return "nothing measured depends on it";
    return fmt::format("its standard error is {:.2g} times what would be of use", std / kUnknown);
  }

  void mark(const Eigen::VectorXd& direction, double std) {
    constexpr double kPart = 0.1;  // of the squared length
    std::vector<std::string> names;
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      if (direction(i) * direction(i) >= kPart) {
        names.push_back(model_.quantities[static_cast<std::size_t>(i)].name());
      }
    }
    const std::string why = names.size() == 1
                                ? "these logs leave it open: " + width(std)
                                : fmt::format("these logs show only a combination of {}: {}",
                                              fmt::join(names, ", "), width(std));
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (direction(i) * direction(i) < kPart) continue;
      fit_.identifiable[at] = false;
      fit_.why[at] = why;
    }
  }

  void conclude() {
    const auto n = static_cast<Eigen::Index>(coordinates_.size());
    fit_.quantities = model_.quantities;
    fit_.coordinates = Eigen::Map<const Eigen::VectorXd>(coordinates_.data(), n);
    fit_.noise = model_.noise;
    fit_.usable = solved_.usable && solved_.converged;
    std::vector<Eigen::VectorXd> scores;
    double correlation_s = 0.0;
    for (const auto& [channel, noise] : model_.noise) {
      correlation_s = std::max(correlation_s, noise.correlation_s);
    }
    const double block_s = std::max(1.0, 5.0 * correlation_s);
    find_unknown(information(block_s, options_.bootstrap > 0 ? &scores : nullptr));
    refuse_stopped();
    fit_.bootstrap95.assign(static_cast<std::size_t>(n), std::nullopt);
    if (options_.bootstrap > 0) bootstrap(scores);
    fit_.aic = 2.0 * static_cast<double>(n);
    for (const auto& [channel, noise] : model_.noise) {
      const double phi =
          noise.correlation_s > 0.0 ? std::exp(-noise.step_s / noise.correlation_s) : 0.0;
      fit_.aic += noise.count * std::log(noise.std * noise.std * (1.0 - phi * phi));
    }
    report();
  }

  /// Block bootstrap: blocks of scores drawn with replacement, one Gauss-Newton step each;
  /// percentiles.
  void bootstrap(const std::vector<Eigen::VectorXd>& scores) {
    const auto n = static_cast<Eigen::Index>(coordinates_.size());
    std::vector<std::vector<double>> draws(static_cast<std::size_t>(n));
    Random random(options_.seed, 2);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
    for (const Eigen::VectorXd& score : scores) mean += score / static_cast<double>(scores.size());
    for (int b = 0; b < options_.bootstrap; ++b) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
      for (std::size_t i = 0; i < scores.size(); ++i) {
        const auto pick =
            static_cast<std::size_t>(random.uniform() * static_cast<double>(scores.size()));
        sum += scores[pick] - mean;
      }
      const Eigen::VectorXd step = fit_.covariance * sum;
      for (Eigen::Index i = 0; i < n; ++i) {
        draws[static_cast<std::size_t>(i)].push_back(fit_.coordinates(i) + step(i));
      }
    }
    for (std::size_t i = 0; i < draws.size(); ++i) {
      std::sort(draws[i].begin(), draws[i].end());
      const auto at = [&](double share) {
        const double place = share * static_cast<double>(draws[i].size() - 1);
        return draws[i][static_cast<std::size_t>(std::lround(place))];
      };
      fit_.bootstrap95[i] =
          Interval{model_.quantities[i].value(at(0.025)), model_.quantities[i].value(at(0.975))};
    }
  }

  void report() {
    EstimatorReport& report = fit_.report;
    report.subject = FitSubject::kLog;
    report.estimator = Estimator::kTrajectory;
    int samples = 0;
    for (const auto& [channel, noise] : model_.noise) {
      report.noise += fmt::format("{}{} {:.3g} {}", report.noise.empty() ? "" : ", ",
                                  info(channel).name, noise.std, info(channel).unit);
      if (noise.correlation_s > 0.0) {
        report.noise += fmt::format(" correlated over {:.3g} s", noise.correlation_s);
      }
      samples += noise.count;
    }
    for (std::size_t i = 0; i < model_.quantities.size(); ++i) {
      const FreeQuantity& q = model_.quantities[i];
      const auto at = static_cast<Eigen::Index>(i);
      EstimatorParameter parameter{q.name(), q.value(coordinates_[i]), {}, {}, {}};
      if (fit_.identifiable[i]) {
        const double error = std::sqrt(fit_.covariance(at, at));
        const double half = t_quantile_95(1e6) * error;
        parameter.std_error = q.jacobian(coordinates_[i]) * error;
        parameter.ci95 = fit_.bootstrap95[i].value_or(
            Interval{q.value(coordinates_[i] - half), q.value(coordinates_[i] + half)});
      }
      report.parameters.push_back(std::move(parameter));
    }
    report.residual_std = 1.0;
    report.rows_used = samples;
    report.degrees_of_freedom =
        samples - static_cast<int>(coordinates_.size() + model_.start.size() * windows_.size());
    report.stop_reason = solved_.stop_reason;
    test_residuals();
  }

  /// The standardised residuals of each channel should be white: longest window first.
  void test_residuals() {
    for (const auto& [channel, noise] : model_.noise) {
      std::vector<double> series;
      for (const FitWindow& window : windows_) {
        for (std::size_t i = 0; i < window.samples.size(); ++i) {
          if (window.samples[i].channel == channel) {
            series.push_back(window.residuals(static_cast<Eigen::Index>(i)));
          }
        }
      }
      if (auto test = whiteness(series, 10)) {
        test->name += fmt::format(" of {}", info(channel).name);
        fit_.report.diagnostics.push_back(*test);
      }
      if (auto test = normality(series)) {
        test->name += fmt::format(" of {}", info(channel).name);
        fit_.report.diagnostics.push_back(*test);
      }
    }
  }

  const std::vector<DrivingLog>& logs_;
  const LogFitOptions& options_;
  LogModel model_;
  double fine_step_s_ = 0.0;
  std::vector<LogSignals> signals_;
  std::vector<FitWindow> windows_;
  std::vector<double> starts_;
  std::vector<double> coordinates_;
  std::vector<double> centre_;
  Solved solved_;
  LogFit fit_;
};

}  // namespace

std::string FreeQuantity::name() const {
  switch (kind) {
    case Kind::kParameter:
      return std::string(info(id).name);
    case Kind::kDelay:
      return std::string(kInputDelayName);
    case Kind::kBias:
      return fmt::format("{}{}", kBiasPrefix, info(channel).name);
  }
  return {};
}

double FreeQuantity::value(double coordinate) const {
  return logarithmic ? std::exp(coordinate) : coordinate;
}

double FreeQuantity::jacobian(double coordinate) const {
  return logarithmic ? std::exp(coordinate) : 1.0;
}

LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  return LogFitter(logs, options).run();
}

std::map<LogChannel, double> prediction_error(const DrivingLog& log, const Plant<double>& plant,
                                              double delay_s) {
  const LogSignals signals(log);
  Plant<double> resolved = plant;
  const double step_s = replay_step_s(plant);
  resolved.surge.rest_speed = rest_speed(plant.surge, plant.mass_norm, step_s);
  resolved.yaw.rest_speed = rest_speed(plant.yaw, plant.inertia_norm, step_s);
  struct Sums {
    double error = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
  };
  std::map<LogChannel, Sums> sums;
  for (const LogWindow& window : windows_of(log, kWindow_s)) {
    replay(signals, window.begin, window.end, resolved, delay_s > 0.0 ? &delay_s : nullptr, step_s,
           measured_start(window), [&](std::size_t row, const State<double>& state) {
             for (const LogChannel channel : kChannels) {
               if (!log[channel] || !log[channel]->fresh[row]) continue;
               if (channel == LogChannel::kSteering && !log.steering_command_rad) continue;
               const double measured = log[channel]->value[row];
               const double error = channel_of(state, channel) - measured;
               Sums& s = sums[channel];
               s.error += error * error;
               s.sum += measured;
               s.squares += measured * measured;
               ++s.count;
             }
           });
  }
  std::map<LogChannel, double> nrmse;
  for (const auto& [channel, s] : sums) {
    const double mean = s.sum / s.count;
    const double variance = s.squares / s.count - mean * mean;
    if (variance > 0.0) nrmse[channel] = std::sqrt(s.error / s.count / variance);
  }
  return nrmse;
}

}  // namespace awmr
