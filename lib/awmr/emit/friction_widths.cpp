#include "friction_widths.h"

#include "awmr/control/yaw_mode.h"

namespace awmr {

std::vector<FrictionWidth> friction_widths(const ModeGains& gains, std::optional<YawMode> mode) {
  std::vector<FrictionWidth> widths;
  if (mode) {
    widths.push_back(
        {.mode = *mode,
         .width_radps = gains.in(*mode).friction_width_at(steering_share<double>(*mode)),
         .symbol = "w0",
         .meaning = "the controller compensates friction in proportion to s = psi_d_dot + lambda e "
                    "(psi_d: desired heading, e: heading error) while |s| is below w0"});
  } else {
    widths.push_back(
        {.mode = YawMode::kSteering,
         .width_radps = gains.in(YawMode::kSteering).heading.friction_width_radps,
         .symbol = "w0",
         .meaning =
             "in steering mode, the controller compensates friction in proportion to s = "
             "psi_d_dot + lambda e (psi_d: desired heading, e: heading error) while |s| is "
             "below w0; in differential mode this limit is 0.02 rad/s, with an observer w0"});
    widths.push_back({.mode = YawMode::kCombined,
                      .is_second = true,
                      .width_radps = gains.in(YawMode::kCombined).friction_width_at(0.5),
                      .symbol = "",
                      .meaning = "w0 of the combined mode"});
  }
  std::erase_if(widths, [](const FrictionWidth& width) {
    return !(width.width_radps > feed_forward_rest_speed<double>());
  });
  return widths;
}

}  // namespace awmr
