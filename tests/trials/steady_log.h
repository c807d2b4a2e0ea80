/// A log with two stretches of steady motion: one straight, one turning.
#pragma once

#include <string>

namespace awmr::testing {

/// 0..4 s: speed rising; 4..8 s: another thrust, steady at 1 m/s; 8..12 s: a steady left turn.
inline std::string steady_log_text() {
  std::string text = "t_s,force_left,force_right,steering_deg,speed_mps,yaw_rate_radps\n";
  for (int i = 0; i < 120; ++i) {
    const double t = 0.1 * i;
    const bool turn = t >= 8.0;
    const double force = t < 4.0 ? 0.1 : turn ? 0.2 : 0.3;
    const double wiggle = i % 2 == 0 ? 1e-3 : -1e-3;
    text += std::to_string(t) + "," + std::to_string(force) + "," + std::to_string(force) + "," +
            (turn ? "10" : "0") + "," + std::to_string(t < 4.0 ? 0.2 * t + wiggle : 1.0 + wiggle) +
            "," + std::to_string((turn ? 0.3 : 0.0) + wiggle) + "\n";
  }
  return text;
}

}  // namespace awmr::testing
