/// Trials of motor lag and servo rate limit that score tests cannot replace: a rate limit has no
/// effect on a fit that does not reach it, and a motor lag has nearly the same effect as other
/// terms. Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// True if a motor lag is given in the vehicle file or estimated.
bool has_motor_lag(const LogModel& model);

/// Replaces all low-pass filters of the sensors by one motor lag. Reason: the search adds filters
/// one by one, although a single motor lag has the same effect in nearly linear motion. Empty if
/// this does not lower AIC, if there are fewer than two filters, or if the model already has a
/// motor lag.
std::optional<NoiseIteration> with_motor_lag_for_filters(const NoiseIteration& settled, Loss loss);

/// Adds a motor lag to a fit with a positive delay of the commands. Empty if there is no such
/// delay, if the model already has a motor lag, or if AIC does not decrease by more than 10.
std::optional<NoiseIteration> with_motor_lag_and_delay(const NoiseIteration& settled, Loss loss);

/// Estimates a servo rate limit below that of the vehicle file. Empty if a rate limit is already
/// estimated, if the servo's time constant is not estimated, or if AIC does not decrease by more
/// than 10.
std::optional<NoiseIteration> with_slower_servo(const NoiseIteration& settled, Loss loss);

}  // namespace awmr
