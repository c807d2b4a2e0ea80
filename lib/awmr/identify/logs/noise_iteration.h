/// Alternating estimation of the fit and of its noise levels. Private to identify/.
#pragma once

#include "awmr/identify/logs/log_problem.h"

namespace awmr {

struct NoiseIteration {
  LogProblem problem;  ///< with its noise levels and the weights of a robust loss
  SearchPoint point;
};

/// The raw errors at a point; under a robust loss they are clipped, so that outliers do not
/// increase the noise.
ErrorsByChannel errors_by_channel(const LogProblem& problem,
                                  const std::vector<WindowErrors>& errors, Loss loss);

/// Alternates fits and noise estimates from the residuals, until no level changes by more than 1 %,
/// at most `rounds` times. A single round, for ranking models, integrates with longer steps.
inline constexpr int kNoiseRounds = 6;
NoiseIteration settle_noise(LogProblem problem, SearchPoint point, Loss loss,
                            int rounds = kNoiseRounds);

}  // namespace awmr
