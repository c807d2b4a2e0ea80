/// Converts a resistance law to the smallest table that meets the error bound, which the chip
/// interpolates (control/resistance_table.h). Private to emit/.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "awmr/control/resistance_table.h"
#include "awmr/core/result.h"
#include "awmr/emit/emit.h"

namespace awmr {

/// g as a function of a speed >= 0: g1 of m/s or g3 of rad/s.
using ResistanceLaw = std::function<double(double)>;

/// Returns the top speed of a table: the smallest power of two, from 1 to 64 m/s or rad/s, at which
/// g exceeds 1.5 times the largest force or moment. The vehicle cannot reach a higher speed.
double table_top(const ResistanceLaw& law, double full_scale);

/// Returns the smallest table of `law` up to `top` that meets the error bound in the chip's
/// arithmetic. The error is relative to the law, or to a tenth of `full_scale` where the law is
/// smaller; its bound is `error_share`. Without `error_share`, the bound is kTableError or, if no
/// table achieves that, the smallest possible error. The table is not used below `rest_speed`.
/// `name` is for the message. Errors (refused): even the largest table exceeds the bound.
Result<EmittedTable> resistance_table(const std::string& name, const ResistanceLaw& law,
                                      double full_scale, double top,
                                      std::optional<double> error_share, double rest_speed);

}  // namespace awmr
