/// Trial fits of the logs with further terms of the vehicle or sensor model, such as a delay, motor
/// lag, smoothing or wheel slip. AIC decides between each trial and the fit without these terms.
/// Private to identify/.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/logs/problem/noise_iteration.h"
#include "awmr/identify/logs/problem/score_test.h"

namespace awmr {

/// AIC of a fit under its own noise model: -2 ln L + 2 (n + number of noise parameters), up to a
/// constant that depends only on the logs. n: number of free quantities.
double akaike_of(const NoiseIteration& fit);

/// Adds the terms `more` to the estimated quantities of the fit `settled`, and makes a short fit
/// (one round). The fit starts with white noise in place of drift, because drift could absorb the
/// effect of the terms. Initial guesses are limited to three large changes
/// (FreeQuantity::large_change), except for quantities that only describe a form
/// (FreeQuantity::is_form()). Trials of several terms start at a fit without terms (`more` empty):
/// each of them would else first search the optimum with white noise.
NoiseIteration tried(const NoiseIteration& settled, const std::vector<FreeTerm>& more);

/// A short fit (one round) of a sample of the windows of `settled`: kSampleWindows evenly spaced
/// ones, and the first of each log.
NoiseIteration sample_of(const NoiseIteration& settled);

/// The windows and initial states of `settled`, with the quantities and coordinates of `found`, a
/// fit of some of these windows. A start for a fit of all windows.
NoiseIteration with_all_windows(const NoiseIteration& settled, const NoiseIteration& found);

/// Makes a converged fit that starts at `from`. Empty unless its AIC is lower than that of
/// `settled` by more than 10.
std::optional<NoiseIteration> settled_if_better(const NoiseIteration& settled, Extended from);

/// The fit with the lowest AIC among those considered.
class LowestAic {
 public:
  explicit LowestAic(const NoiseIteration& start) : criterion_(akaike_of(start)) {}

  /// Keeps the fit if its AIC is lower than the lowest AIC so far by more than `by`. Returns true
  /// if it was kept.
  bool consider(NoiseIteration fit, double by = 0.0) {
    const double criterion = akaike_of(fit);
    if (!(criterion + by < criterion_)) return false;
    criterion_ = criterion;
    best_ = std::move(fit);
    return true;
  }
  /// The fit that was kept; empty if no fit had a lower AIC than `start`.
  std::optional<NoiseIteration>& best() { return best_; }
  double criterion() const { return criterion_; }  ///< the lowest AIC so far

 private:
  std::optional<NoiseIteration> best_;
  double criterion_;
};

/// True if the vehicle file gives a motor lag or the fit estimates one.
bool has_motor_lag(const LogModel& model);

/// Replaces all low-pass filters of the sensors by one motor lag. Reason: the search adds filters
/// one by one, although one motor lag has the same effect as all of them in nearly linear motion.
/// Empty if the motor lag does not lower AIC, if there are fewer than two filters, or if the model
/// already has a motor lag.
std::optional<NoiseIteration> with_motor_lag_for_filters(const NoiseIteration& settled);

/// True if the delay of a reading can be that of a mean, half of the averaging time: a program
/// averages over a row of the log or more, so the delay is at least about half of a row spacing.
/// Criterion: a quarter.
bool may_be_mean(const LogModel& model, double delay_s);

/// Replaces the low-pass filters of speed and yaw rate by means over twice the delay of the filters
/// (FreeQuantity::Kind::kAveraging). Empty if no channel has a filter whose
/// delay can be that of a mean (may_be_mean()) and no averaging. The AIC may be higher.
std::optional<NoiseIteration> with_averaging_for_filters(const NoiseIteration& settled);

/// Replaces the low-pass filter of one channel by a delay of its readings that is as long as that
/// of the filter. Reason: without the other lags of the fit, which the search may have added later,
/// a filter describes the readings better than a delay. Empty if no delay lowers AIC.
std::optional<NoiseIteration> with_delay_for_filter(const NoiseIteration& settled);

/// Adds a motor lag to a fit with a positive delay of the commands. Empty if there is no such
/// delay, if the model already has a motor lag, or if AIC does not decrease by more than 10.
std::optional<NoiseIteration> with_motor_lag_and_delay(const NoiseIteration& settled);

/// Estimates a servo rate limit below that of the vehicle file. Empty if the fit already estimates
/// a rate limit, if it does not estimate the servo's time constant, or if AIC does not decrease by
/// more than 10.
std::optional<NoiseIteration> with_slower_servo(const NoiseIteration& settled);

}  // namespace awmr
