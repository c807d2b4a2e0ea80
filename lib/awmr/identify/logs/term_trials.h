/// Trial fits of the logs that also estimate further terms of the vehicle or sensor model, such as
/// a delay, motor lag, smoothing or wheel slip. Each is compared by AIC with the fit without these
/// terms. Private to identify/.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/logs/noise_iteration.h"
#include "awmr/identify/logs/score_test.h"

namespace awmr {

/// AIC of a fit, computed with its own noise levels.
double akaike_of(const NoiseIteration& fit);

/// Adds the terms `more` to the estimated quantities and fits one round, starting with white noise
/// in place of drift. Initial guesses are limited to three large changes
/// (FreeQuantity::large_change).
NoiseIteration tried(const NoiseIteration& settled, const std::vector<FreeTerm>& more, Loss loss);

/// Fits from `from` to convergence. Returns the fit if its AIC is lower than that of `settled` by
/// more than 10, else empty.
std::optional<NoiseIteration> settled_if_better(const NoiseIteration& settled, Extended from,
                                                Loss loss);

/// The fit with the lowest AIC among those considered.
class LowestAic {
 public:
  explicit LowestAic(const NoiseIteration& start) : criterion_(akaike_of(start)) {}

  /// Keeps the fit if its AIC is lower than the lowest so far by more than `by`. Returns true if it
  /// was kept.
  bool consider(NoiseIteration fit, double by = 0.0) {
    const double criterion = akaike_of(fit);
    if (!(criterion + by < criterion_)) return false;
    criterion_ = criterion;
    best_ = std::move(fit);
    return true;
  }
  /// The kept fit; empty if no fit had a lower AIC than the start.
  std::optional<NoiseIteration>& best() { return best_; }

 private:
  std::optional<NoiseIteration> best_;
  double criterion_;
};

}  // namespace awmr
