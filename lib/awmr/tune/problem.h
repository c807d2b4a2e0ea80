/// Search space of the gains, and the evaluation of its points. Private to tune/.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Largest number of searched values: lambda, mu, epsilon, mu_s, epsilon_s and the observer's
/// bandwidth.
inline constexpr unsigned kMaxDimensions = 6;
/// Natural logarithms of the searched values; the last value is 0 if no observer is searched.
using Point = std::array<double, kMaxDimensions>;

/// Fills in each absent bound of a gain: from its smallest value in `gains` divided by kBoundFactor
/// to its largest value times kBoundFactor.
void bound_around(std::span<const Gains<double>> gains, GainBounds& bounds);

/// Ranges of the logarithms of the gains, and conversions between points and gains.
class SearchSpace {
 public:
  /// Precondition: all bounds and the observer's limits are set.
  explicit SearchSpace(const TuneOptions& options);

  unsigned dimension() const { return observer_ ? kMaxDimensions : kMaxDimensions - 1; }
  const Point& lower_corner() const { return lower_corner_; }
  const Point& upper_corner() const { return upper_corner_; }
  /// Returns the gains at the point, clamped to the bounds because exp() rounds.
  Gains<double> gains_at(const Point& point) const;
  Point point_of(const Gains<double>& gains) const;

 private:
  std::array<Interval, kMaxDimensions> range_{};
  Point lower_corner_{};
  Point upper_corner_{};
  std::optional<ObserverSearch> observer_;
};

/// A set of gains with its evaluation.
struct Candidate {
  Gains<double> gains{};
  /// Largest residual of the constraints, the activity limits and the goals; the gains are feasible
  /// if it is <= 0.
  double violation = 0.0;
  double objective = 0.0;  ///< value of the objective; meaningful only if `simulated`
  /// True if the runs were simulated. False if a constraint is violated before any run.
  bool simulated = false;
  bool valid = false;  ///< true: the objective is finite, and no run breaks off
  /// True if the gains meet the constraints that need no simulation, and no simulated run breaks
  /// off.
  bool meets_constraints = false;

  bool feasible() const { return simulated && valid && violation <= 0.0; }
};

/// True if `a` is better than `b`. Feasible candidates are better than infeasible candidates. Two
/// feasible candidates are compared by objective. Infeasible candidates that meet the constraints
/// (and only miss goals or activity limits) are better than those that do not; within each group,
/// the smaller violation is better.
bool better(const Candidate& a, const Candidate& b);

/// A point with its evaluation.
struct Looked {
  Point point{};
  Candidate candidate{};
  std::vector<double> residuals{};  ///< one for each of Problem::names()

  /// Value that NLopt minimises: the objective, or a larger number if the point has no valid runs.
  double value() const;
};

/// Evaluates points, keeps the best point and counts the evaluations.
class Problem {
 public:
  Problem(const TuneOptions& options, const ConstraintContext& context, const Objective& objective);

  /// Names of the residuals. First come the required constraints, then the limit of the control
  /// variation (`activity_max`) of each mode, then the goals that are not soft.
  const std::vector<std::string>& names() const { return names_; }
  const SearchSpace& space() const { return space_; }
  unsigned constraints() const { return static_cast<unsigned>(names_.size()); }
  /// True: every set of gains is simulated, even if it violates a constraint, because the local
  /// search needs the objective of such gains.
  bool simulate_all = false;
  /// For each constraint, the largest residual with which it still counts as met: 0, except for a
  /// constraint that active_constraints() relaxes.
  std::vector<double> tolerated;
  Candidate nearest;    ///< the best candidate so far, in the order of better()
  int evaluations = 0;  ///< number of evaluated points
  int simulated = 0;    ///< number of points whose runs were simulated
  /// All feasible points, with their settling time and control variation.
  std::vector<FrontPoint> met;
  /// Evaluations whose objective is better than that of all evaluations before them.
  std::vector<SearchStep> steps;

  /// Evaluates the points, and simulates the runs of all of them together. Returns the results in
  /// the order of the points.
  std::vector<Looked> look_at(std::span<const Point> points);

  /// The same problem, without evaluated points and without reports of the progress.
  Problem unused() const;
  /// Adds the evaluations of a part of the search that used unused().
  void add(const Problem& part);

 private:
  Looked before_runs(const Point& point) const;
  void add_runs(const Evaluation& evaluation, Looked& looked) const;
  void report() const;

  const TuneOptions& options_;
  bool reports_ = true;  ///< true: calls TuneOptions::progress
  SearchSpace space_;
  const ConstraintContext& context_;
  const Objective& objective_;
  std::vector<std::string> names_;
  /// Index in names_ of the limit of the steering rate.
  std::optional<std::size_t> steering_rate_;
  std::size_t before_runs_ = 0;  ///< number of residuals that need no simulation
  /// Indices in Evaluation::goal_quantile of the goals that are not soft.
  std::vector<std::size_t> hard_goals_;
};

}  // namespace awmr
