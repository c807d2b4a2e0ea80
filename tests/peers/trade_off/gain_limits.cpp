#include "peers/trade_off/gain_limits.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace awmr::peers {
namespace {

/// State of the heading loop: psi, r, and the yaw moments by the steering angle and by the
/// wheel forces, each with unit gain.
using Vector4 = Eigen::Vector4d;

struct Loop {
  double own_rate = 0.0;    ///< g3'/I'z of the body, 1/s
  double known_rate = 0.0;  ///< g3'/I'z of the model, which the law feeds forward, 1/s
  double gain = 1.0;        ///< I'z of the model divided by that of the body
  double by_forces = 0.0;   ///< fraction of the moment that the wheel forces make
  double motor_s = 0.0;
  double latency_s = 0.0;
};

/// Returns the state after `time_s` with a constant command, by the classical Runge-Kutta method.
Vector4 held(const Loop& loop, const Geometry& g, Vector4 x, double command, double time_s) {
  const double servo_s = g.servo_s > 0.0 ? g.servo_s : g.sample_s;
  const auto rates = [&](const Vector4& y) {
    const double forces = loop.motor_s > 0.0 ? y[3] : command;
    return Vector4(y[1],
                   -loop.own_rate * y[1] +
                       loop.gain * ((1.0 - loop.by_forces) * y[2] + loop.by_forces * forces),
                   (command - y[2]) / servo_s,
                   loop.motor_s > 0.0 ? (command - y[3]) / loop.motor_s : 0.0);
  };
  double fastest = std::max(loop.own_rate, 1.0 / servo_s);
  if (loop.motor_s > 0.0) fastest = std::max(fastest, 1.0 / loop.motor_s);
  const int steps = std::max(4, static_cast<int>(std::ceil(5.0 * fastest * time_s)));
  const double h = time_s / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector4 a = rates(x);
    const Vector4 b = rates(x + 0.5 * h * a);
    const Vector4 c = rates(x + 0.5 * h * b);
    const Vector4 d = rates(x + h * c);
    x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return x;
}

/// Smallest damping ratio of the sampled loop, from the eigenvalues of its transition matrix over
/// one sample. Modes that decay to less than a tenth of their amplitude within a sample are
/// ignored. With latency, a mode that decays n times as fast as the slowest one counts with a
/// damping ratio of at least n/20.
double damping(const Loop& loop, const Geometry& g, const LawGains& k, bool counts_decay) {
  const double k_s = k.mu / k.epsilon;
  // Delayed commands, the oldest first: the oldest acts in the first part of the sample, the next
  // one after it.
  const double late = loop.latency_s / g.sample_s;
  const auto whole = static_cast<Eigen::Index>(late + 1e-9);
  const double part = std::max(0.0, late - static_cast<double>(whole));
  const bool is_split = part > 1e-9;
  const Eigen::Index n = 4 + whole + (is_split ? 1 : 0);
  Eigen::RowVectorXd law = Eigen::RowVectorXd::Zero(n);
  law[0] = -k.lambda * k_s;
  law[1] = loop.known_rate - k.lambda - k_s;
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd x = Eigen::VectorXd::Unit(n, i);
    const double ordered = law * x;
    const double acts = whole > 0 ? x[is_split ? 5 : 4] : ordered;
    Vector4 body = x.head<4>();
    if (is_split) body = held(loop, g, body, x[4], part * g.sample_s);
    map.col(i).head<4>() = held(loop, g, body, acts, (is_split ? 1.0 - part : 1.0) * g.sample_s);
    for (Eigen::Index j = 4; j + 1 < n; ++j) map(j, i) = x[j + 1];
    if (n > 4) map(n - 1, i) = ordered;
  }
  const Eigen::VectorXcd poles = Eigen::EigenSolver<Eigen::MatrixXd>(map, false).eigenvalues();
  double slowest = 1e300;
  for (const std::complex<double>& z : poles) slowest = std::min(slowest, -std::log(std::abs(z)));
  double least = 1.0;
  for (const std::complex<double>& z : poles) {
    if (std::abs(z) < 0.1) continue;
    const std::complex<double> s = std::log(z);
    if (!(std::abs(s) > 0.0)) continue;
    double ratio = -s.real() / std::abs(s);
    if (counts_decay && slowest > 0.0) ratio = std::max(ratio, -s.real() / slowest / 20.0);
    least = std::min(least, ratio);
  }
  return least;
}

/// damping() with a negligible lag of the servo if only the wheel forces turn the vehicle, and of the
/// motors if only the steering does.
double damping_of_acting(Loop loop, Geometry g, const LawGains& k, bool counts_decay) {
  const double negligible_s = 0.1 * g.sample_s;
  if (loop.by_forces >= 1.0) g.servo_s = negligible_s;
  if (loop.by_forces <= 0.0) loop.motor_s = negligible_s;
  return damping(loop, g, k, counts_decay);
}

double least_damping(const Controls& c, const Geometry& g, const Body& body, double rate,
                     double latency_s, double motor_s, bool counts_decay = false) {
  Loop loop{.own_rate = body.yaw.slope(rate) / body.inertia,
            .known_rate = c.fed_forward == FedForward::kMeasured
                              ? c.known.yaw.slope(rate) / c.known.inertia
                              : 0.0,
            .gain = c.known.inertia / body.inertia,
            .by_forces = 1.0,
            .motor_s = motor_s,
            .latency_s = latency_s};
  double least = damping_of_acting(loop, g, c.gains, counts_decay);
  if (!(g.servo_s > 0.0)) return least;
  for (const double share : {0.5, 0.0}) {
    loop.by_forces = share;
    least = std::min(least, damping_of_acting(loop, g, c.gains, counts_decay));
  }
  return least;
}

/// Returns the expectation of f(z) g(z) for a standard normal z.
template <class F, class G>
double mean(const F& f, const G& g) {
  constexpr int kPoints = 2000;
  double sum = 0.0;
  double weights = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double z = -5.0 + 10.0 * (i + 0.5) / kPoints;
    const double weight = std::exp(-0.5 * z * z);
    sum += weight * f(z) * g(z);
    weights += weight;
  }
  return sum / weights;
}

/// RMS rate of the steering command due to noise while a heading is held, deg/s. `width_radps`: the
/// mode's friction width w0; `steered`: the share of the yaw moment that the steering makes. The
/// yaw acceleration is
///   a(n) + 1{|n| < w0} b(m) + c(m),   n, m: noise of the yaw rate and of the heading
/// with dry friction b of a vehicle at rest; a, b and c are odd.
double steering_rate_degps(const Controls& c, const Geometry& g, const SensorErrors& errors,
                           double speed_mps, double steered, double width_radps) {
  const LawGains& gains = c.gains;
  const double k = gains.mu / gains.epsilon;
  const Friction& yaw = c.known.yaw;
  const bool is_fed = c.fed_forward == FedForward::kMeasured;
  const double rest = is_fed && yaw.coulomb > 0.0 ? width_radps : 0.0;
  const auto rests = [&](double z) {
    return std::abs(z) * errors.yaw_rate_radps < rest ? 1.0 : 0.0;
  };
  const auto by_rate = [&](double z) {
    const double n = z * errors.yaw_rate_radps;
    const double fed =
        is_fed && !(rests(z) > 0.0) ? std::copysign(yaw.of_magnitude(std::abs(n)), n) : 0.0;
    return fed / c.known.inertia - (gains.lambda + k) * n;
  };
  const auto friction = [&](double z) {
    if (!(rest > 0.0)) return 0.0;
    const double intent = gains.lambda * errors.heading_rad * z;
    return yaw.of_magnitude(rest) / c.known.inertia * std::clamp(intent / rest, -1.0, 1.0);
  };
  const auto by_heading = [&](double z) { return gains.lambda * k * errors.heading_rad * z; };
  const double share = rest > 0.0 ? mean(rests, rests) : 0.0;
  const double squares = mean(by_rate, by_rate) + mean(by_heading, by_heading) +
                         share * (mean(friction, friction) + 2.0 * mean(friction, by_heading));
  return 2.0 * steered * c.known.inertia * std::sqrt(2.0 * squares) /
         (g.front_axle_m * c.known.surge.of_magnitude(speed_mps) * g.sample_s) * 180.0 /
         std::numbers::pi;
}

/// Largest yaw moment, divided by F_max, m, of the weaker of the modes differential and steering.
double authority(const Geometry& g, const Body& body, double speed_mps) {
  const double thrust = body.surge.of_magnitude(speed_mps);
  const double by_forces =
      4.0 * g.half_track_m * std::min(g.force_max - thrust / 4.0, thrust / 4.0 - g.force_min);
  if (!(g.servo_s > 0.0)) return by_forces;
  return std::min(by_forces, g.front_axle_m * thrust * std::tan(0.5 * g.steering_max_rad));
}

double above(double value, double limit) { return value / limit - 1.0; }
double below(double value, double limit) { return 1.0 - value / limit; }

}  // namespace

double excess(const Controls& c, const Geometry& g, const SensorErrors& errors,
              const std::vector<Body>& bodies, const Limits& limits, const Examined& examined) {
  const LawGains& k = c.gains;
  const double speed_rate = k.speed_mu / k.speed_epsilon;
  const double latency_s = std::max(errors.heading_latency_s, errors.yaw_rate_latency_s);
  const double slowest = std::numbers::pi / 180.0;
  double worst = above(k.epsilon / k.mu * k.lambda, limits.margin);
  if (g.servo_s > 0.0) {
    for (const auto& [steered, width] :
         {std::pair{1.0, k.friction_width_radps}, std::pair{0.5, combined_width_radps(k)}}) {
      const double rate = steering_rate_degps(c, g, errors, examined.speed_mps, steered, width);
      worst = std::max(worst, above(rate, limits.steering_rate_degps));
    }
  }
  std::vector<const Body*> all{&c.known};
  for (const Body& body : bodies) all.push_back(&body);
  for (const Body* body : all) {
    if (worst > 0.0) return worst;
    const auto take = [&worst](double e) { worst = std::max(worst, e); };
    const double rate = speed_rate * c.known.mass / body->mass;
    take(above(rate * g.sample_s, 0.5));
    const double lag_s = std::max(g.servo_s, g.motor_s) + latency_s + 0.5 * g.sample_s;
    take(above(rate * lag_s, 1.0 / (4.0 * limits.damping * limits.damping)));
    take(below(k.mu, 0.2 * body->yaw.of_magnitude(examined.fastest_radps) / c.known.inertia));
    take(below(k.speed_mu, 0.2 * body->surge.of_magnitude(examined.speed_mps) / c.known.mass));
    take(above(c.known.inertia * k.lambda * k.mu / k.epsilon * errors.heading_rad,
               limits.noise_share * authority(g, *body, examined.speed_mps)));
    if (worst > 0.0) return worst;
    for (const double share : {1.0 / 60.0, 1.0 / 12.0, 1.0 / 3.0, 1.0}) {
      const double r = std::max(share * examined.fastest_radps, slowest);
      take(below(least_damping(c, g, *body, r, 0.0, 0.0), limits.damping));
      if (share > 0.5 || share < 0.05) {
        take(below(least_damping(c, g, *body, r, latency_s, g.motor_s, true), limits.late_damping));
        take(below(least_damping(c, g, *body, r, 2.0 * latency_s + g.sample_s, g.motor_s),
                   limits.delayed_damping));
      }
      if (worst > 0.0) return worst;
    }
  }
  return worst;
}

}  // namespace awmr::peers
