/// Simulated tables of trials of a vehicle whose parameters are known.
#pragma once

#include <cmath>

#include "awmr/core/random.h"
#include "awmr/identify/identify.h"

namespace awmr::testing {

struct Truth {
  double a1, b1, a3, b3, mass_norm;
};
inline constexpr Truth kTruths[] = {{1.3157, 0.8841, 0.3028, 0.825, 0.08},
                                    {0.9, 0.55, 0.2, 1.2, 0.5}};

inline Vehicle vehicle() {
  Vehicle v{};
  v.name = "synthetic";
  v.mass_kg = 37.0;
  v.length_m = 1.32;
  v.width_m = 0.78;
  v.sway_alpha = 3.0;
  v.steering_time_constant_s = 0.02;
  return v;
}

/// Ten surge, eight turning and three coast-down runs. The noise is a factor exp(sigma N), N
/// standard normal, on the force of each row, as the log-linear estimator assumes.
inline TrialData synthetic(const Truth& t, double sigma, std::uint64_t seed) {
  Random random(seed, 0);
  TrialData data;
  data.surge = TrialSet<SurgeRow>{"surge.csv", {}, 0};
  data.turning = TrialSet<TurningRow>{"turning.csv", {}, 0};
  data.coastdown = TrialSet<StopTimeRow>{"coastdown.csv", {}, 0};
  for (int i = 1; i <= 10; ++i) {
    const double speed = 0.16 * i;
    const double force = t.a1 * std::pow(speed, t.b1) * std::exp(sigma * random.normal());
    data.surge->rows.push_back({i + 1, force, speed, {}, {}});
  }
  for (int i = 1; i <= 8; ++i) {
    const double rate = 0.04 * i;
    const double moment = t.a3 * std::pow(rate, t.b3) * std::exp(sigma * random.normal());
    data.turning->rows.push_back({i + 1, 0.1, 0.35, moment, rate, {}, {}});
  }
  for (int i = 1; i <= 3; ++i) {
    const double speed = 0.5 * i;
    const double stop = t.mass_norm * std::pow(speed, 1.0 - t.b1) / ((1.0 - t.b1) * t.a1);
    data.coastdown->rows.push_back({i + 1, speed, stop});
  }
  return data;
}

}  // namespace awmr::testing
