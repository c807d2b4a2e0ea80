/// Terms of motors and servo that score tests do not show: a limit that the fit does not reach has
/// no effect, and a motor lag has nearly the effect of other terms. Each function returns the fit
/// with its term; empty if that does not lower AIC by more than 10. Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {

/// True if a motor lag is given in the vehicle file or estimated.
bool has_motor_lag(const LogModel& model);

/// A motor lag in place of all filters of the sensors; any lower AIC suffices. Empty also if there
/// are fewer than two filters, or a motor lag already. In nearly linear motion the lag and the filters have the same
/// effect, and the filters were added one by one.
std::optional<NoiseIteration> with_motor_lag_for_filters(const NoiseIteration& settled, Loss loss);

/// A motor lag in addition to a positive delay of the commands.
std::optional<NoiseIteration> with_motor_lag_and_delay(const NoiseIteration& settled, Loss loss);

/// A servo that is slower than the vehicle file says.
std::optional<NoiseIteration> with_slower_servo(const NoiseIteration& settled, Loss loss);

}  // namespace awmr
