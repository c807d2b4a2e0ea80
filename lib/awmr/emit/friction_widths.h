/// Friction widths in emitted files. A friction width w0 is the yaw rate, rad/s, below which the
/// heading law feeds the Coulomb friction in yaw forward smoothly. Private to emit/.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "awmr/model/mode_gains.h"

namespace awmr {

/// A friction width w0 (Gains::friction_width_at()).
struct FrictionWidth {
  YawMode mode{};  ///< the mode whose gains have this width
  /// true: w0 of the combined mode, in a file that also has w0 of the steering mode
  bool is_second = false;
  double width_radps = 0.0;
  std::string_view symbol;   ///< "w0"; empty if `meaning` contains it
  std::string_view meaning;  ///< without symbol and unit
};

/// Returns the friction width of `mode`, or those of steering and combined mode if `mode` is
/// absent. Widths at their smallest value, 0.02 rad/s, are left out, because this value is the
/// default.
std::vector<FrictionWidth> friction_widths(const ModeGains& gains, std::optional<YawMode> mode);

}  // namespace awmr
