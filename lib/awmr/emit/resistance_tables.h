/// A resistance law as the table that the chip interpolates (control/resistance_table.h), no larger
/// than a bound on its error asks for. Private to emit/.
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

/// The least power of two at which g exceeds the largest force or moment by half of it, so that no
/// speed the vehicle can drive at lies beyond: between 1 and 64 m/s or rad/s.
double table_top(const ResistanceLaw& law, double full_scale);

/// The smallest table of `law` up to `top` whose error, in the chip's own arithmetic, stays below
/// `error_share` of the law or, where that is less, of a tenth of `full_scale`; without `error_share`
/// that of kTableError or, where there is none, the one with the least error. Below `rest_speed` it is
/// not read, and may be as far off as it likes. `name` is for the message.
/// Errors (refused): not even the largest table does.
Result<EmittedTable> resistance_table(const std::string& name, const ResistanceLaw& law,
                                      double full_scale, double top,
                                      std::optional<double> error_share, double rest_speed);

}  // namespace awmr
