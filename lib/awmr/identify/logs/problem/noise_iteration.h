/// Alternately estimates the coordinates of a log fit and its noise levels. Private to identify/.
#pragma once

#include <limits>

#include "awmr/identify/logs/problem/log_problem.h"

namespace awmr {

/// A least-squares problem with noise levels estimated from its residuals, and its solution.
struct NoiseIteration {
  LogProblem problem;  ///< the problem with its estimated noise levels and robust weights
  SearchPoint point;
  double first_cost = 0.0;   ///< cost after the first round, under the initial noise levels
  double change_cost = 0.0;  ///< sum of WindowErrors::change_cost
  bool gave_up = false;      ///< true: first_cost exceeds NoiseRounds::give_up_above
};

/// Collects the errors (before whitening) by sensor. If the fit has a robust loss, clips them at
/// three robust standard deviations, because outliers would increase the estimated noise.
ErrorsBySensor errors_by_sensor(const LogProblem& problem, const std::vector<WindowErrors>& errors);

/// Options of settle_noise().
struct NoiseRounds {
  int most = 6;  ///< largest number of rounds; 1 for fits that only rank models
  /// The iteration stops after the first round if the cost then exceeds this value.
  double give_up_above = std::numeric_limits<double>::infinity();
  /// True: the search starts at the result of a fit to a part of the same logs, with its noise
  /// levels. The first round then has normal integration steps, and may be the only one. False: the
  /// first round has longer steps (rough_step_s()) to save time, and at least one more round
  /// follows.
  bool is_near = false;
};

/// Alternately fits the coordinates and estimates the noise levels from the residuals (one round
/// does both). Ends when no noise level changes by 1 % or more, or after NoiseRounds::most rounds.
NoiseIteration settle_noise(LogProblem problem, SearchPoint point, const NoiseRounds& rounds = {});

}  // namespace awmr
