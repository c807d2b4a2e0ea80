#include "awmr/identify/logs/problem/log_problem.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/logs/problem/product_sums.h"

namespace awmr {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double prior_std(const LogProblem& problem, std::size_t i) {
  return kPriorStd * problem.model.quantities[i].large_change;
}
/// Residual (x_i - initial_i) / std_i of the prior of coordinate x_i, centred on its initial guess.
double prior_residual(const LogProblem& problem, std::size_t i, double x) {
  return (x - problem.initial[i]) / prior_std(problem, i);
}

/// Work (Effort) of one evaluation of the residuals and the Jacobian of all windows: the number of
/// integration steps times the number of values that each step integrates.
std::int64_t numbers_integrated(const LogProblem& problem) {
  double numbers = 0.0;
  for (const FitWindow& window : problem.windows) {
    const std::vector<double>& t_s = window.rows.log->t_s;
    const double duration_s = t_s[window.rows.end - 1] - t_s[window.rows.begin];
    const double steps =
        static_cast<double>(window.samples().size()) + duration_s / problem.model.longest_step_s;
    const std::size_t derivatives =
        problem.model.quantities.size() + problem.model.initial.size() + window.changes.size();
    numbers += steps * static_cast<double>(1 + derivatives);
  }
  return std::llround(numbers);
}

/// Computes the residuals and the Jacobian of all windows in parallel at each new point, before
/// Ceres requests those of the first window. The Jacobian is always computed, because it takes
/// little more time than the residuals.
///
/// If a coordinate is at its bound and the cost decreases towards values beyond the bound, this
/// class fixes the coordinate: it sets the derivatives with respect to it to 0. (Ceres would
/// instead cut the step at the bound, and the step of the other coordinates would then be wrong.)
class Evaluator : public ceres::EvaluationCallback {
 public:
  Evaluator(const LogProblem& problem, const SearchPoint& point)
      : problem_(problem), point_(point) {}

  void PrepareForEvaluation(bool, bool new_point) final {
    if (!new_point && !sums_.empty()) return;
    sums_ = sums_at(problem_, point_);
    if (problem_.effort) problem_.effort->add(numbers_integrated(problem_));
    triangles_.clear();
    for (const WindowSums& sums : sums_) {
      triangles_.push_back(sums.finite ? triangle_of(sums.products) : Triangle{});
    }
    hold_at_bounds();
  }

  const LogProblem& problem() const { return problem_; }
  bool finite(std::size_t window) const { return sums_[window].finite; }
  const Triangle& triangle(std::size_t window) const { return triangles_[window]; }
  bool is_held(std::size_t coordinate) const { return held_[coordinate]; }

 private:
  void hold_at_bounds() {
    held_.assign(problem_.bounds.size(), false);
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const double x = point_.coordinates[i];
      double slope = prior_residual(problem_, i, x) / prior_std(problem_, i);
      for (const WindowSums& sums : sums_) {
        slope += sums.products(eigen_index(i), sums.products.cols() - 1);
      }
      held_[i] = (x <= problem_.bounds[i].lo && slope > 0.0) ||
                 (x >= problem_.bounds[i].hi && slope < 0.0);
    }
    for (Triangle& triangle : triangles_) {
      for (Eigen::Index i = 0; i < rows_of(held_) && triangle.r.size() > 0; ++i) {
        if (held_[at(i)]) triangle.r.col(i).setZero();
      }
    }
  }

  const LogProblem& problem_;
  const SearchPoint& point_;
  std::vector<WindowSums> sums_;
  std::vector<Triangle> triangles_;
  std::vector<bool> held_;  ///< one per coordinate: true if it is fixed at its bound
};

/// Cost function of one window for Ceres, with the residuals and the Jacobian that Evaluator has
/// computed and reduced to a triangular matrix. Parameter blocks: the coordinates, and the initial
/// state of the window.
class WindowCost : public ceres::CostFunction {
 public:
  WindowCost(const Evaluator& evaluator, std::size_t window)
      : evaluator_(evaluator),
        window_(window),
        quantities_(static_cast<int>(evaluator.problem().model.quantities.size())),
        initial_(static_cast<int>(evaluator.problem().model.initial.size())) {
    mutable_parameter_block_sizes()->push_back(quantities_);
    mutable_parameter_block_sizes()->push_back(initial_);
    set_num_residuals(quantities_ + initial_ + 1);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const final {
    if (!evaluator_.finite(window_)) return false;
    const Triangle& triangle = evaluator_.triangle(window_);
    const Eigen::Index rows = triangle.z.size();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = triangle.z;
    residuals[rows] = triangle.rest;
    if (!jacobians) return true;
    if (jacobians[0]) fill(triangle.r.leftCols(quantities_), jacobians[0]);
    if (jacobians[1]) fill(triangle.r.rightCols(initial_), jacobians[1]);
    return true;
  }

 private:
  template <class Columns>
  static void fill(const Columns& columns, double* jacobian) {
    Eigen::Map<RowMajor> all(jacobian, columns.rows() + 1, columns.cols());
    all.topRows(columns.rows()) = columns;
    all.bottomRows(1).setZero();
  }

  const Evaluator& evaluator_;
  std::size_t window_;
  int quantities_;
  int initial_;
};

class PriorCost : public ceres::CostFunction {
 public:
  explicit PriorCost(const Evaluator& evaluator) : evaluator_(evaluator) {
    const int n = static_cast<int>(evaluator.problem().initial.size());
    mutable_parameter_block_sizes()->push_back(n);
    set_num_residuals(n);
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const final {
    const LogProblem& problem = evaluator_.problem();
    const std::size_t n = problem.initial.size();
    if (jacobians && jacobians[0]) std::fill_n(jacobians[0], n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      residuals[i] = prior_residual(problem, i, x[0][i]);
      if (!jacobians || !jacobians[0] || evaluator_.is_held(i)) continue;
      jacobians[0][i * n + i] = 1.0 / prior_std(problem, i);
    }
    return true;
  }

 private:
  const Evaluator& evaluator_;
};

void bound(ceres::Problem& problem, const std::vector<Interval>& bounds,
           std::vector<double>& coordinates) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    coordinates[i] = std::clamp(coordinates[i], bounds[i].lo, bounds[i].hi);
    problem.SetParameterLowerBound(coordinates.data(), static_cast<int>(i), bounds[i].lo);
    problem.SetParameterUpperBound(coordinates.data(), static_cast<int>(i), bounds[i].hi);
  }
}

/// Time until the deadline, s; at least 1 ms, because Ceres rejects smaller limits.
double seconds_until(std::chrono::steady_clock::time_point deadline) {
  const std::chrono::duration<double> left = deadline - std::chrono::steady_clock::now();
  return std::max(1e-3, left.count());
}

ceres::Solver::Options solver_options(double function_tolerance) {
  silence_ceres();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 60;
  options.function_tolerance = function_tolerance;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_consecutive_invalid_steps = 30;
  return options;
}

/// Ends a search that makes no progress, which is so in two cases:
///   - Two steps in a row fail, each with a predicted decrease of -ln L below 0.05. Such a decrease
///     changes an estimate by less than a third of a standard error. The cost is rough on this
///     scale, because Runge-Kutta steps cross the kink of the resistance where speed or yaw rate
///     changes its sign. Further steps would only find local minima.
///   - Eight steps together decrease -ln L by less than 0.01. The search then creeps along a
///     direction that the logs do not determine.
class EndWithoutProgress : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& step) final {
    constexpr double kLittle = 0.05;
    constexpr int kFailures = 2;
    const double promised = step.cost_change / step.relative_decrease;
    const bool failed = step.iteration > 0 && !step.step_is_successful;
    const bool fails_near_end = failed && step.step_is_valid && promised < kLittle;
    failures_ = fails_near_end ? failures_ + 1 : 0;
    if (!failed || fails_near_end) add(step.cost);
    if (failures_ >= kFailures) reason_ = "further steps improve -ln L by less than 0.05";
    if (creeps()) reason_ = "eight steps improved -ln L by less than 0.01";
    return reason_.empty() ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }
  /// Reason for ending the search; empty if it was not ended.
  const std::string& reason() const { return reason_; }

 private:
  static constexpr std::size_t kSteps = 8;

  /// Appends the lowest cost so far. `cost`: cost after the last step; after a failed step, that of
  /// the rejected point.
  void add(double cost) {
    lowest_.push_back(lowest_.empty() ? cost : std::min(lowest_.back(), cost));
  }
  bool creeps() const {
    constexpr double kLittle = 0.01;
    return lowest_.size() > kSteps &&
           lowest_[lowest_.size() - 1 - kSteps] - lowest_.back() < kLittle;
  }

  int failures_ = 0;
  std::vector<double> lowest_;
  std::string reason_;
};

/// Ends a search when the work of all searches reaches its limit (Effort). Parallel searches do not
/// use it, because their end would then depend on the number of threads.
class EndAtLimit : public ceres::IterationCallback {
 public:
  explicit EndAtLimit(const LogProblem& problem) : problem_(problem) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) final {
    has_ended_ = problem_.ends_at_limit && problem_.effort && problem_.effort->is_over();
    return has_ended_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool has_ended() const { return has_ended_; }

 private:
  const LogProblem& problem_;
  bool has_ended_ = false;
};

void report_end(const ceres::Solver::Summary& summary, bool at_limit, const std::string& stalled,
                Solved& solved) {
  const bool is_stalled = !stalled.empty() && !at_limit;
  solved.cost = summary.final_cost;
  solved.converged = is_stalled || converged(summary);
  solved.usable = summary.IsSolutionUsable();
  solved.stop_reason = at_limit     ? "the limit of computation was reached"
                       : is_stalled ? "converged: " + stalled
                                    : stop_reason(summary);
}

/// Response of a search to a step after which the simulation is not finite.
enum class LineSearch {
  /// Ceres cuts steps at the bounds and shortens steps that fail. One Jacobian per step.
  kOff,
  /// Ceres searches along every step for a point with a finite simulation. Two Jacobians per step.
  kOn,
};

Solved search_from(const LogProblem& problem, SearchPoint from, double function_tolerance,
                   LineSearch line_search) {
  Solved solved;
  solved.point = std::move(from);
  SearchPoint& point = solved.point;
  Evaluator evaluator(problem, point);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &evaluator;
  ceres::Problem search(problem_options);
  double* const coordinates = point.coordinates.data();
  // Ceres eliminates the initial states in the order of their addresses. All of them are in one
  // vector, so this is the order of the windows in every run, and results are reproducible.
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < problem.windows.size(); ++i) {
    double* const initial_state = point.initial_states.data() + i * problem.model.initial.size();
    search.AddResidualBlock(new WindowCost(evaluator, i), nullptr, coordinates, initial_state);
    ordering->AddElementToGroup(initial_state, 0);
  }
  ordering->AddElementToGroup(coordinates, 1);
  search.AddResidualBlock(new PriorCost(evaluator), nullptr, coordinates);
  bound(search, problem.bounds, point.coordinates);
  ceres::Solver::Options options = solver_options(function_tolerance);
  options.linear_solver_ordering = ordering;
  if (line_search == LineSearch::kOff) options.max_num_line_search_step_size_iterations = 0;
  if (problem.deadline) options.max_solver_time_in_seconds = seconds_until(*problem.deadline);
  EndWithoutProgress end_without_progress;
  options.callbacks.push_back(&end_without_progress);
  EndAtLimit end_at_limit(problem);
  options.callbacks.push_back(&end_at_limit);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &search, &summary);
  report_end(summary, end_at_limit.has_ended(), end_without_progress.reason(), solved);
  return solved;
}

}  // namespace

Solved solve(const LogProblem& problem, SearchPoint from, double function_tolerance) {
  Solved quick = search_from(problem, from, function_tolerance, LineSearch::kOff);
  if (quick.usable) return quick;
  return search_from(problem, std::move(from), function_tolerance, LineSearch::kOn);
}

}  // namespace awmr
