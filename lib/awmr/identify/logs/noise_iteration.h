/// The fit and its noise levels, each from the other. Private to identify/.
#pragma once

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

struct NoiseIteration {
  LogProblem problem;  ///< with its noise levels and the weights of a robust loss
  SearchPoint point;
};

/// The raw errors at a point, clipped under a robust loss: outliers shall not pass for noise.
ErrorsByChannel errors_by_channel(const LogProblem& problem,
                                  const std::vector<WindowErrors>& errors, Loss loss);

/// Fits, takes the noise of every channel from its residuals, fits again: until no level changes by
/// more than a hundredth, `rounds` at most. One round ranks models: it integrates with longer steps.
inline constexpr int kNoiseRounds = 6;
NoiseIteration settle_noise(LogProblem problem, SearchPoint point, Loss loss,
                            int rounds = kNoiseRounds);

}  // namespace awmr
