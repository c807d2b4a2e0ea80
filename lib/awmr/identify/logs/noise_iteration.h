/// Alternately estimates the coordinates of a log fit and its noise levels. Private to identify/.
#pragma once

#include <limits>

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// A problem with estimated noise, and its solution.
struct NoiseIteration {
  LogProblem problem;  ///< includes the noise levels and the weights of a robust loss
  SearchPoint point;
  double first_cost = 0.0;  ///< cost after the first round, with the initial noise levels
  bool gave_up = false;     ///< that cost exceeds NoiseRounds::give_up_above
};

/// Collects the raw errors by channel. Under a robust loss, errors are clipped at three robust
/// standard deviations, so that outliers do not increase the noise.
ErrorsByChannel errors_by_channel(const LogProblem& problem,
                                  const std::vector<WindowErrors>& errors, Loss loss);

/// Options of settle_noise().
struct NoiseRounds {
  int most = 6;  ///< largest number of rounds; 1 for fits that only rank models
  /// The iteration ends after the first round if the cost then exceeds this.
  double give_up_above = std::numeric_limits<double>::infinity();
  /// True: the point and the noise levels are those of a fit to a part of the same logs. The first
  /// round then integrates with the normal steps, and can be the only one. False: the first round
  /// uses longer steps (rough_step_s()), and a second one follows.
  bool is_near = false;
};

/// Alternately fits the coordinates and estimates the noise from the residuals, until no noise
/// level changes by 1 % or more.
NoiseIteration settle_noise(LogProblem problem, SearchPoint point, Loss loss,
                            const NoiseRounds& rounds = {});

}  // namespace awmr
