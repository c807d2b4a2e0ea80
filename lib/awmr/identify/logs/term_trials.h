/// Trial fits of the logs with further terms of the vehicle or sensor model, such as a delay, motor
/// lag, smoothing or wheel slip. Each trial is compared by AIC with the fit without these terms.
/// Private to identify/.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/logs/noise_iteration.h"
#include "awmr/identify/logs/score_test.h"

namespace awmr {

/// AIC of a fit, computed with its own noise levels.
double akaike_of(const NoiseIteration& fit);

/// Adds the terms `more` to the estimated quantities and makes a short fit (one round). The fit
/// starts with white noise in place of drift, so that drift cannot absorb the effect of the terms.
/// Initial guesses are limited to three large changes (FreeQuantity::large_change), except those of
/// quantities that only describe a form (FreeQuantity::is_form()).
NoiseIteration tried(const NoiseIteration& settled, const std::vector<FreeTerm>& more, Loss loss);

/// Makes a converged fit that starts at `from`. Returns it if its AIC is lower than that of
/// `settled` by more than 10, else empty.
std::optional<NoiseIteration> settled_if_better(const NoiseIteration& settled, Extended from,
                                                Loss loss);

/// The fit with the lowest AIC among those considered.
class LowestAic {
 public:
  explicit LowestAic(const NoiseIteration& start) : criterion_(akaike_of(start)) {}

  /// Keeps the fit if its AIC is lower by more than `by` than the lowest AIC so far. Returns true
  /// if the fit was kept.
  bool consider(NoiseIteration fit, double by = 0.0) {
    const double criterion = akaike_of(fit);
    if (!(criterion + by < criterion_)) return false;
    criterion_ = criterion;
    best_ = std::move(fit);
    return true;
  }
  /// The fit that was kept; empty if no fit had a lower AIC than `start`.
  std::optional<NoiseIteration>& best() { return best_; }

 private:
  std::optional<NoiseIteration> best_;
  double criterion_;
};

}  // namespace awmr
