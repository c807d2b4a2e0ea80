#include "peers/trade_off/heading_simulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace awmr::peers {

double Friction::of_magnitude(double w) const {
  return coulomb + alpha * std::pow(w, beta) + quadratic * w * w;
}

double Friction::slope(double w) const {
  return alpha * beta * std::pow(w, beta - 1.0) + 2.0 * quadratic * w;
}

namespace {

constexpr double kDeg = 180.0 / std::numbers::pi;

double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

/// Returns the speed after the time `step` under the acceleration `push` and the friction. Dry
/// friction is integrated exactly until the speed is 0, the smooth part implicitly with its chord.
double after_step(const Friction& friction, double inertia, double w, double push, double step) {
  double next = w + step * push;
  const double dry = step * friction.coulomb / inertia;
  if (std::abs(next) <= dry) return 0.0;
  next -= std::copysign(dry, next);
  const double middle = std::max(0.5 * (std::abs(w) + std::abs(next)), 1e-9);
  const double chord =
      (friction.alpha * std::pow(middle, friction.beta - 1.0) + friction.quadratic * middle) /
      inertia;
  // Implicit trapezoidal rule if it is stable, else implicit Euler.
  const double h = step * chord;
  if (h < 1.0) return (next - 0.5 * h * w) / (1.0 + 0.5 * h);
  return next / (1.0 + h);
}

/// Resistance that a control law feeds forward at the speed w. For |w| < `rest`, dry friction
/// changes its sign linearly with w + `intent` instead of jumping.
double fed_forward(const Friction& friction, double w, double intent, double rest = 0.02) {
  if (friction.coulomb > 0.0 && std::abs(w) < rest) {
    return friction.of_magnitude(rest) * std::clamp((w + intent) / rest, -1.0, 1.0);
  }
  if (!(std::abs(w) > 0.0)) return 0.0;
  return std::copysign(friction.of_magnitude(std::abs(w)), w);
}

struct Commands {
  double left = 0.0, right = 0.0, angle = 0.0;
};

/// Largest steering angle at a thrust. Below a thrust of 1/16, the tangent of half the angle falls
/// linearly to 0.
double largest_angle(const Geometry& g, double thrust) {
  const double share = std::clamp(16.0 * thrust, 0.0, 1.0);
  return 2.0 * std::atan(share * std::tan(0.5 * g.steering_max_rad));
}

/// Sets the wheel forces that make this thrust and yaw moment at the steering angle c.angle:
///   F = (thrust -+ moment/d)/(2 (1 + cos angle))
void set_forces(const Geometry& g, double thrust, double moment, Commands& c) {
  const double share = 1.0 / (2.0 * (1.0 + std::cos(c.angle)));
  c.left = std::clamp(share * (thrust - moment / g.half_track_m), g.force_min, g.force_max);
  c.right = std::clamp(share * (thrust + moment / g.half_track_m), g.force_min, g.force_max);
}

Commands allocate(const Geometry& g, Mode mode, double thrust, double moment) {
  thrust = std::clamp(thrust, 4.0 * g.force_min, 4.0 * g.force_max);
  Commands c;
  if (mode == Mode::kDifferential) {
    set_forces(g, thrust, moment, c);
    return c;
  }
  const double steered = mode == Mode::kCombined ? 0.5 * moment : moment;
  const double most = largest_angle(g, thrust);
  const bool able = thrust > 1e-6;
  // moment = l_f thrust tan(angle/2)
  const double angle = able ? 2.0 * std::atan(steered / (g.front_axle_m * thrust)) : 0.0;
  c.angle = std::clamp(angle, -most, most);
  if (mode == Mode::kSteering) {
    set_forces(g, thrust, 0.0, c);
    return c;
  }
  const bool limited = !able || std::abs(angle) > most;
  set_forces(g, thrust, moment - g.front_axle_m * thrust * std::tan(0.5 * c.angle), c);
  const double delivered = g.half_track_m * (c.right - c.left) * (1.0 + std::cos(c.angle));
  const double made = g.front_axle_m * thrust * std::tan(0.5 * c.angle) + delivered;
  if (!limited && std::abs(moment - made) > 1e-12 * std::abs(moment)) {
    const double left_thrust = (c.left + c.right) * (1.0 + std::cos(c.angle));
    const double needed = moment - delivered;
    const double stop = largest_angle(g, thrust);
    if (left_thrust > 1e-6) {
      c.angle = std::clamp(2.0 * std::atan(needed / (g.front_axle_m * left_thrust)), -stop, stop);
    } else {
      c.angle = 0.0;
    }
  }
  return c;
}

struct Reference {
  double psi = 0.0, rate = 0.0, acceleration = 0.0;
};

/// Moves the heading reference towards `goal` by a critically damped filter of 4 rad/s with a rate
/// limit.
void lead(double goal, double limit, double sample_s, Reference& ref) {
  constexpr double kBandwidth = 4.0;
  const double rate = std::clamp(0.5 * kBandwidth * wrapped(goal - ref.psi), -limit, limit);
  const double most = kBandwidth * limit;
  ref.acceleration = std::clamp(2.0 * kBandwidth * (rate - ref.rate), -most, most);
  ref.rate += sample_s * ref.acceleration;
  ref.psi += sample_s * ref.rate;
}

struct Readings {
  double psi, r, u, v;
};

Commands commands_of(const Controls& c, const Geometry& g, Mode mode, const Readings& m,
                     const Reference& ref, double speed_mps) {
  const LawGains& k = c.gains;
  const double rate_error = ref.rate - m.r;
  const double s = rate_error + k.lambda * wrapped(ref.psi - m.psi);
  const double w = c.fed_forward == FedForward::kMeasured ? m.r : ref.rate;
  const double width = mode == Mode::kSteering   ? k.friction_width_radps
                       : mode == Mode::kCombined ? combined_width_radps(k)
                                                 : 0.02;
  const double moment = fed_forward(c.known.yaw, w, s, width) +
                        c.known.inertia * (ref.acceleration + k.lambda * rate_error +
                                           k.mu * std::clamp(s / k.epsilon, -1.0, 1.0));
  const double e = speed_mps - m.u;
  const double fed = std::min(m.u, speed_mps + k.speed_epsilon);
  const double thrust =
      fed_forward(c.known.surge, fed, e) +
      c.known.mass * (k.speed_mu * std::clamp(e / k.speed_epsilon, -1.0, 1.0) - m.r * m.v);
  return allocate(g, mode, thrust, moment);
}

struct State {
  double psi = 0.0, u = 0.0, v = 0.0, r = 0.0, angle = 0.0, left = 0.0, right = 0.0;
};

void move(const Body& b, const Geometry& g, const Commands& c, int steps, State& s) {
  const double h = g.sample_s / steps;
  const double kept = g.motor_s > 0.0 ? std::exp(-h / g.motor_s) : 0.0;
  for (int i = 0; i < steps; ++i) {
    s.left = c.left + kept * (s.left - c.left);
    s.right = c.right + kept * (s.right - c.right);
    if (g.servo_s > 0.0) {
      s.angle += h * std::clamp((c.angle - s.angle) / g.servo_s, -g.steering_rate_radps,
                                g.steering_rate_radps);
    }
    const double cosine = std::cos(s.angle);
    const double sine = std::sin(s.angle);
    const double sum = s.left + s.right;
    const double moment =
        g.front_axle_m * sum * sine + g.half_track_m * (s.right - s.left) * (1.0 + cosine);
    const double r = s.r;
    const double u = after_step(b.surge, b.mass, s.u, sum * (1.0 + cosine) / b.mass + s.r * s.v, h);
    s.v = (s.v + h * (sum * sine / b.mass - s.r * s.u)) / (1.0 + h * b.sway / b.mass);
    s.u = u;
    s.r = after_step(b.yaw, b.inertia, s.r, moment / b.inertia, h);
    s.psi += 0.5 * h * (r + s.r);
  }
}

/// Accumulates the metrics of a run, sample by sample.
class Meter {
 public:
  Meter(const Geometry& g, const Course& course) : g_(g), course_(course) {}

  void begin_step(double t, double error) {
    end_step();
    start_ = t;
    size_ = error * kDeg;
    settled_ = 0.0;
    is_out_ = false;
    begun_ = true;
  }
  void add(double t, double error, double u_mps, const Commands& c) {
    figures_.speed_itae_ms += g_.sample_s * t * std::abs(course_.speed_mps - u_mps);
    const double deg = error * kDeg;
    const bool out = std::abs(deg) > std::max(0.02 * std::abs(size_), 0.5);
    if (is_out_ && !out) settled_ = t - start_;
    is_out_ = out;
    figures_.overshoot_deg = std::max(figures_.overshoot_deg, size_ > 0.0 ? -deg : deg);
    if (rows_++ > 0) {
      const double turned = c.angle - before_.angle;
      if (g_.servo_s > 0.0) figures_.variation += std::abs(turned) / g_.steering_max_rad;
      figures_.variation +=
          (std::abs(c.left - before_.left) + std::abs(c.right - before_.right)) / g_.force_max;
      squares_ += turned * turned;
    }
    before_ = c;
  }
  RunFigures result(double duration) {
    end_step();
    figures_.variation /= duration;
    figures_.steering_rms_degps =
        kDeg * std::sqrt(squares_ / static_cast<double>(rows_ - 1)) / g_.sample_s;
    return figures_;
  }

 private:
  void end_step() {
    if (!begun_) return;
    figures_.settling_s = std::max(figures_.settling_s, is_out_ ? course_.hold_s : settled_);
  }

  const Geometry& g_;
  const Course& course_;
  RunFigures figures_;
  Commands before_;
  double start_ = 0.0, size_ = 0.0, settled_ = 0.0, squares_ = 0.0;
  bool is_out_ = false, begun_ = false;
  std::size_t rows_ = 0;
};

std::size_t samples_in(double seconds, double sample_s) {
  return static_cast<std::size_t>(std::floor(seconds / sample_s + 1e-9));
}

}  // namespace

std::size_t readings_of(const Course& course, const Geometry& vehicle) {
  const double duration = course.hold_s * static_cast<double>(course.headings_rad.size());
  return samples_in(duration, vehicle.sample_s) + 1;
}

RunFigures drive(const Body& body, const Geometry& vehicle, const SensorErrors& errors,
                 const Controls& controls, Mode mode, const Course& course, const Noise& noise,
                 double step_s) {
  const double ts = vehicle.sample_s;
  const int steps = std::max(1, static_cast<int>(std::ceil(ts / step_s - 1e-9)));
  const std::size_t readings = readings_of(course, vehicle);
  std::vector<State> past;
  past.reserve(readings);
  // Returns the value of a quantity `late` seconds before the k-th sample.
  const auto read = [&](std::size_t k, double late, double State::*quantity) {
    const double time = std::max(0.0, static_cast<double>(k) - late / ts) + 1e-9;
    const auto before = static_cast<std::size_t>(time);
    const double share = time - static_cast<double>(before);
    const double old = past[before].*quantity;
    return before < k ? old + share * (past[before + 1].*quantity - old) : old;
  };
  State state;
  Reference ref;
  Meter meter(vehicle, course);
  std::size_t step = course.headings_rad.size();
  for (std::size_t k = 0; k < readings; ++k) {
    const double t = static_cast<double>(k) * ts;
    past.push_back(state);
    const Readings m{
        read(k, errors.heading_latency_s, &State::psi) + errors.heading_rad * noise[0][k],
        read(k, errors.yaw_rate_latency_s, &State::r) + errors.yaw_rate_radps * noise[1][k],
        read(k, errors.speed_latency_s, &State::u) + errors.speed_mps * noise[2][k], state.v};
    const std::size_t now = std::min(static_cast<std::size_t>(std::floor(t / course.hold_s + 1e-9)),
                                     course.headings_rad.size() - 1);
    const double goal = course.headings_rad[now];
    if (k == 0) ref.psi = m.psi;
    if (course.rate_limit_radps) {
      lead(goal, *course.rate_limit_radps, ts, ref);
    } else {
      ref = {goal, 0.0, 0.0};
    }
    const Commands c = commands_of(controls, vehicle, mode, m, ref, course.speed_mps);
    const double error = wrapped(goal - state.psi);
    if (now != step) meter.begin_step(t, error);
    step = now;
    meter.add(t, error, state.u, c);
    move(body, vehicle, c, steps, state);
  }
  return meter.result(static_cast<double>(readings - 1) * ts);
}

}  // namespace awmr::peers
