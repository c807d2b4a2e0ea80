/// Simulator of the heading control for the cross-check of `tune`. It shares no code with lib/awmr:
/// integrator, laws, allocation, sensors and metrics are written from the equations of the READMEs.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace awmr::peers {

/// g(w) = (c + alpha |w|^beta + q w^2) sgn w, over F_max.
struct Friction {
  double coulomb = 0.0, alpha = 0.0, beta = 1.0, quadratic = 0.0;
  double of_magnitude(double w) const;  ///< g(w), w > 0
  double slope(double w) const;         ///< g'(w), w > 0
};

/// Masses and resistances of a vehicle, over F_max.
struct Body {
  double mass = 0.0;     ///< m', s^2/m
  double inertia = 0.0;  ///< I'z, s^2 m
  Friction surge, yaw;
  double sway = 0.0;  ///< a_s
};

struct Geometry {
  double front_axle_m = 0.0, half_track_m = 0.0;
  double steering_max_rad = 0.0, steering_rate_radps = 0.0;
  double servo_s = 0.0;  ///< time constant of the servo; 0: no steering
  double sample_s = 0.0;
  double force_min = -1.0, force_max = 1.0;  ///< range of the force of one wheel, over F_max
  double motor_s = 0.0;                      ///< time constant of the motors' lag
};

struct SensorErrors {
  double heading_rad = 0.0, yaw_rate_radps = 0.0, speed_mps = 0.0;  ///< standard deviations
  double heading_latency_s = 0.0, yaw_rate_latency_s = 0.0, speed_latency_s = 0.0;
};

struct LawGains {
  double lambda = 0.0, mu = 0.0, epsilon = 0.0;
  double speed_mu = 0.0, speed_epsilon = 0.0;
  double friction_width_radps =
      0.02;  ///< below this yaw rate, dry friction is fed forward in proportion to the rate
  double combined_friction_width_radps = 0.0;  ///< the same in combined mode; 0: half of it
};

/// Friction width in combined mode.
inline double combined_width_radps(const LawGains& k) {
  if (k.combined_friction_width_radps > 0.0) return k.combined_friction_width_radps;
  return std::max(0.02, 0.5 * k.friction_width_radps);
}

/// Yaw rate for which the heading law feeds the resistance g3 forward: the measured one (as in the
/// paper) or the reference.
enum class FedForward { kMeasured, kReference };

struct Controls {
  Body known;  ///< the model on which the control laws are based
  LawGains gains;
  FedForward fed_forward = FedForward::kMeasured;
};

enum class Mode { kDifferential, kSteering, kCombined };

/// Heading commands, each held for `hold_s`, at a constant speed. With `rate_limit_radps`, a
/// second-order filter limits their rate.
struct Course {
  double speed_mps = 0.0, hold_s = 0.0;
  std::vector<double> headings_rad;
  std::optional<double> rate_limit_radps;
};

/// Standard normal numbers for the sensor noise of one run: heading, yaw rate, speed.
using Noise = std::array<std::vector<double>, 3>;

struct RunFigures {
  double settling_s = 0.0;     ///< longest of all steps; hold_s for a step that does not settle
  double overshoot_deg = 0.0;  ///< largest travel beyond a commanded heading
  double variation = 0.0;      ///< total variation of the commands over their limits, 1/s
  double steering_rms_degps = 0.0;  ///< RMS rate of the steering command
  double speed_itae_ms = 0.0;       ///< integral of t |u_d - u|, m s
};

/// Simulates one run. `step_s`: step of the integrator; a run with half of it shows the
/// integrator's error.
RunFigures drive(const Body& body, const Geometry& vehicle, const SensorErrors& errors,
                 const Controls& controls, Mode mode, const Course& course, const Noise& noise,
                 double step_s = 2e-3);

/// Number of readings of each sensor on a course.
std::size_t readings_of(const Course& course, const Geometry& vehicle);

}  // namespace awmr::peers
