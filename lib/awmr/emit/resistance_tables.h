/// Converts a resistance law to a table that the chip interpolates (control/resistance_table.h):
/// the smallest table that meets an error bound. Private to emit/.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "awmr/control/resistance_table.h"
#include "awmr/core/result.h"
#include "awmr/emit/emit.h"

namespace awmr {

/// A resistance as a function of a speed >= 0: g1(u) with u in m/s, or g3(r) with r in rad/s.
using ResistanceLaw = std::function<double(double)>;

/// Returns the top speed of a table of `law`, which the vehicle cannot reach: the smallest power of
/// two, from 1 to 64 m/s or rad/s, at which the law is at least 1.5 times the largest force or
/// moment (`full_scale`). 64 if the law is too small even there.
double table_top(const ResistanceLaw& law, double full_scale);

/// Returns the smallest table of `law` up to the speed `top` (m/s or rad/s) whose error, in the
/// chip's float32 arithmetic, is at most `error_share`. The error is relative to the law, or to a
/// tenth of `full_scale` where the law is smaller. If `error_share` is absent, the bound is
/// kTableError or, if no table meets this bound, the smallest possible error. Errors below
/// `rest_speed` do not count, because the chip uses a line through the origin there. `name`:
/// "surge" or "yaw", for the message. Errors (refused): no table is within `error_share`.
Result<EmittedTable> resistance_table(const std::string& name, const ResistanceLaw& law,
                                      double full_scale, double top,
                                      std::optional<double> error_share, double rest_speed);

}  // namespace awmr
