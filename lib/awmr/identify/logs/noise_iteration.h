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
};

/// Collects the raw errors by channel. Under a robust loss, errors are clipped at three robust
/// standard deviations, so that outliers do not increase the noise.
ErrorsByChannel errors_by_channel(const LogProblem& problem,
                                  const std::vector<WindowErrors>& errors, Loss loss);

/// Default maximum of rounds in settle_noise().
inline constexpr int kNoiseRounds = 6;
/// Alternately fits the coordinates and estimates the noise from the residuals, until no noise
/// level changes by 1 % or more, at most `rounds` times. The first round integrates with longer
/// steps (rough_step_s()). Use one round for fits that only rank models. Ends after the first round
/// if the cost then exceeds `give_up_above`.
NoiseIteration settle_noise(LogProblem problem, SearchPoint point, Loss loss,
                            int rounds = kNoiseRounds,
                            double give_up_above = std::numeric_limits<double>::infinity());

}  // namespace awmr
