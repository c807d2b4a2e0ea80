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

/// The smallest power of two, between 1 and 64 m/s or rad/s, at which g exceeds 1.5 times the
/// largest force or moment. So the vehicle cannot reach a higher speed.
double table_top(const ResistanceLaw& law, double full_scale);

/// The smallest table of `law` up to `top` whose error, in the chip's arithmetic, is below
/// `error_share` of the law or, if that is less, of a tenth of `full_scale`. Without `error_share`,
/// the bound is kTableError or, if no table achieves it, the smallest possible error. Below
/// `rest_speed` the table is not used, and its error does not matter. `name` is for the message.
/// Errors (refused): even the largest table exceeds the bound.
Result<EmittedTable> resistance_table(const std::string& name, const ResistanceLaw& law,
                                      double full_scale, double top,
                                      std::optional<double> error_share, double rest_speed);

}  // namespace awmr
