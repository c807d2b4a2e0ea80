#include "awmr/tune/sampled_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <optional>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

/// A pole z of the sampled loop, expressed as s T_s = ln(z). s is the pole of the continuous loop
/// with the same response at the samples, and T_s the sample time.
struct Pole {
  double decay = 0.0;    ///< sigma T_s = -Re(s) T_s; negative: unstable
  double damping = 0.0;  ///< zeta = sigma/|s|
};
Pole pole_of(const std::complex<double>& z) {
  if (std::abs(z) < kGoneWithinASample) return {-std::log(kGoneWithinASample), 1.0};
  const std::complex<double> s = std::log(z);
  const double magnitude = std::abs(s);
  return {-s.real(), magnitude > 0.0 ? -s.real() / magnitude : 0.0};
}

/// Matrix for the states psi, r, w_servo, w_motor and the held command w of SampledHeadingLoop.
using Matrix5 = Eigen::Matrix<double, 5, 5>;

/// Returns the transition over the time t = `time_s` of the states x of the plant x_dot = A x + B
/// w, with constant command w:
///   [Phi Gamma; 0 1] = exp([A B; 0 0] t)
Matrix5 held_over(const SampledHeadingLoop& loop, double time_s) {
  const bool lag = loop.motor_time_constant_s > 0.0;
  Matrix5 continuous = Matrix5::Zero();
  continuous(0, 1) = 1.0;
  continuous(1, 1) = -loop.resistance_rate;
  continuous(1, 2) = loop.input_gain * (1.0 - loop.direct_share);
  continuous(1, lag ? 3 : 4) = loop.input_gain * loop.direct_share;
  continuous(2, 2) = -1.0 / loop.servo_time_constant_s;
  continuous(2, 4) = 1.0 / loop.servo_time_constant_s;
  // Without motor lag, the state w_motor has no effect, so its time constant is arbitrary.
  const double motor_s = lag ? loop.motor_time_constant_s : loop.sample_time_s;
  continuous(3, 3) = -1.0 / motor_s;
  continuous(3, 4) = 1.0 / motor_s;
  return (continuous * time_s).exp();
}

/// A delay as whole samples and a fraction of a sample.
struct SplitDelay {
  int samples;  ///< whole samples, >= 0
  double part;  ///< the rest as a fraction of a sample, [0, 1)
};
SplitDelay split_delay(double delay_s, double sample_time_s) {
  constexpr double kRounding = 1e-9;
  const double delay = delay_s / sample_time_s;
  const double whole = std::floor(delay + kRounding);
  const double part = delay - whole;
  return {static_cast<int>(whole), part > kRounding ? part : 0.0};
}

/// Transition of the plant's states x from one sample to the next, if the command w is delayed by m
/// whole samples and a fraction of a sample. During that fraction, the previous command still acts:
///   x_(j+1) = Phi x_j + Gamma0 w_(j-m) + Gamma1 w_(j-m-1)
struct HeldPlant {
  Eigen::Matrix4d phi;
  Eigen::Vector4d gamma0, gamma1;
};
HeldPlant hold(const SampledHeadingLoop& loop, double part) {
  const Matrix5 whole = held_over(loop, loop.sample_time_s);
  HeldPlant plant{.phi = whole.topLeftCorner<4, 4>(),
                  .gamma0 = whole.topRightCorner<4, 1>(),
                  .gamma1 = Eigen::Vector4d::Zero()};
  if (part > 0.0) {
    plant.gamma0 = held_over(loop, (1.0 - part) * loop.sample_time_s).topRightCorner<4, 1>();
    plant.gamma1 = whole.topRightCorner<4, 1>() - plant.gamma0;
  }
  return plant;
}

/// Returns the matrix of the closed loop from one sample to the next. Its states are those of the
/// plant, then y of an observer, then the delayed commands, oldest first. The new command w is
/// stored as the last delayed command. Without delay, it acts on the plant directly.
Eigen::MatrixXd closed_loop(const SampledHeadingLoop& loop) {
  const SplitDelay delay = split_delay(loop.command_delay_s, loop.sample_time_s);
  const HeldPlant plant = hold(loop, delay.part);
  const bool is_split = delay.part > 0.0;
  const double k = loop.reaching_rate;
  const double l = loop.observer_radps;
  const Eigen::Index states = l > 0.0 ? 5 : 4;
  const Eigen::Index n = delay.samples + (is_split ? 1 : 0);
  Eigen::RowVectorXd law = Eigen::RowVectorXd::Zero(states);
  law(0) = -loop.lambda * k;
  law(1) = loop.fed_forward_rate - loop.lambda - k - l;
  Eigen::MatrixXd closed = Eigen::MatrixXd::Zero(states + n, states + n);
  closed.topLeftCorner<4, 4>() = plant.phi;
  if (l > 0.0) {
    law(4) = -1.0;
    closed(4, 0) = loop.sample_time_s * l * loop.lambda * k;
    closed(4, 1) = loop.sample_time_s * l * (loop.lambda + k);
    closed(4, 4) = 1.0;
  }
  // Lets the command of `i` samples ago act on the plant's states through the vector `gamma`.
  const auto enter = [&](Eigen::Index i, const Eigen::Vector4d& gamma) {
    if (i == 0) {
      closed.topLeftCorner(4, states) += gamma * law;
    } else {
      closed.block<4, 1>(0, states + n - i) = gamma;
    }
  };
  if (is_split) enter(n, plant.gamma1);
  enter(is_split ? n - 1 : n, plant.gamma0);
  if (n > 0) {
    for (Eigen::Index i = 0; i + 1 < n; ++i) closed(states + i, states + 1 + i) = 1.0;
    closed.block(states + n - 1, 0, 1, states) = law;
  }
  return closed;
}

double smallest_damping(const Eigen::MatrixXd& closed) {
  double worst = 1.0;
  for (const auto& z : eigenvalues(closed)) worst = std::min(worst, pole_of(z).damping);
  return worst;
}

/// Makes the lag of a servo or motor negligible if it does not turn the vehicle in this mode. The
/// damping ratio stays the same, because the poles of these lags are real.
SampledHeadingLoop with_acting_lags(SampledHeadingLoop loop) {
  constexpr double kNegligible = 0.1;  // of the sample time
  if (!(loop.direct_share < 1.0)) loop.servo_time_constant_s = kNegligible * loop.sample_time_s;
  if (!(loop.direct_share > 0.0)) loop.motor_time_constant_s = 0.0;
  return loop;
}

std::vector<Pole> poles_of(const SampledHeadingLoop& loop) {
  std::vector<Pole> poles;
  for (const std::complex<double>& z : eigenvalues(closed_loop(loop))) poles.push_back(pole_of(z));
  return poles;
}

/// The frequency response P(w, f) of the open loop without its delay, as defined at
/// delay_margin_s().
class CompensatedLoop {
 public:
  CompensatedLoop(const SampledHeadingLoop& loop, double part)
      : loop_(loop), part_(part), plant_(hold(loop, part)) {}

  std::complex<double> operator()(double omega_radps) const {
    const double t_s = loop_.sample_time_s;
    const std::complex<double> z = std::polar(1.0, omega_radps * t_s);
    const Eigen::Vector4cd by = plant_.gamma0 + plant_.gamma1 * std::conj(z);  // |z| = 1
    // Solves (z I - Phi) x = by for the states x = (psi, r, servo, motor), the last state first.
    // This is possible because a state depends only on states after it, and servo and motor do not
    // depend on each other.
    const Eigen::Matrix4d& phi = plant_.phi;
    const std::complex<double> motor = by(3) / (z - phi(3, 3));
    const std::complex<double> servo = by(2) / (z - phi(2, 2));
    const std::complex<double> r =
        (by(1) + phi(1, 2) * servo + phi(1, 3) * motor) / (z - phi(1, 1));
    const std::complex<double> psi =
        (by(0) + phi(0, 1) * r + phi(0, 2) * servo + phi(0, 3) * motor) / (z - phi(0, 0));
    const double k = loop_.reaching_rate;
    const double l = loop_.observer_radps;
    const std::complex<double> s = (loop_.lambda + k) * r + loop_.lambda * k * psi;
    std::complex<double> w = (loop_.fed_forward_rate - l) * r - s;
    if (l > 0.0) w -= t_s * l * s / (z - 1.0);
    return w * std::polar(1.0, omega_radps * part_ * t_s);
  }

 private:
  const SampledHeadingLoop& loop_;
  double part_;
  HeldPlant plant_;
};

bool is_same_delay(double a_s, double b_s, const SampledHeadingLoop& loop) {
  // Two delays are equal if they differ by less than this fraction of the sample time.
  constexpr double kConverged = 1e-7;
  return std::abs(a_s - b_s) < kConverged * loop.sample_time_s;
}

/// |P|^2 - 1 at w, rad/s.
double excess_at(const CompensatedLoop& open, double omega_radps) {
  return std::norm(open(omega_radps)) - 1.0;
}

/// Returns ranges of the frequency w, rad/s, in each of which |P|, the gain of the open loop,
/// crosses 1.
std::vector<Interval> crossings_of(const SampledHeadingLoop& loop, const CompensatedLoop& open) {
  constexpr int kFrequencies = 100;
  const double k = loop.reaching_rate;
  // The open loop integrates, so its gain |P| is above 1 at low frequencies.
  const double lowest =
      1e-4 * loop.lambda * k / (loop.lambda + k + loop.resistance_rate + loop.fed_forward_rate);
  const double nyquist = pi<double>() / loop.sample_time_s;
  const double ratio = std::pow(nyquist / lowest, 1.0 / kFrequencies);
  std::vector<Interval> ranges;
  double low = lowest;
  bool is_above = excess_at(open, low) > 0.0;
  for (int i = 1; i <= kFrequencies; ++i) {
    const double high = i == kFrequencies ? nyquist : lowest * std::pow(ratio, i);
    const bool was_above = std::exchange(is_above, excess_at(open, high) > 0.0);
    if (is_above != was_above) ranges.push_back({low, high});
    low = high;
  }
  return ranges;
}

/// Returns the smallest delay, s, above `least_s` with which the loop has a pole on the unit circle
/// whose frequency is in one of the ranges. Empty if |P| does not cross 1 in one of the ranges.
std::optional<double> next_crossing_s(const CompensatedLoop& open,
                                      const std::vector<Interval>& ranges, double least_s) {
  constexpr std::uintmax_t kEvaluationsMax = 60;
  constexpr int kBits = 40;
  const auto excess = [&](double omega) { return excess_at(open, omega); };
  double next_s = std::numeric_limits<double>::infinity();
  for (const Interval& range : ranges) {
    const double at_low = excess(range.lo);
    const double at_high = excess(range.hi);
    if ((at_low > 0.0) == (at_high > 0.0)) return std::nullopt;
    std::uintmax_t evaluations = kEvaluationsMax;
    const double omega_radps = boost::math::tools::toms748_solve(
                                   excess, range.lo, range.hi, at_low, at_high,
                                   boost::math::tools::eps_tolerance<double>(kBits), evaluations)
                                   .first;
    const double turn_s = 2.0 * pi<double>() / omega_radps;
    const double delay_s = std::arg(open(omega_radps)) / omega_radps;
    next_s = std::min(next_s, delay_s + turn_s * (std::floor((least_s - delay_s) / turn_s) + 1.0));
  }
  return next_s;
}

/// Computes the delay, s, at which the loop becomes unstable, by fixed-point iteration, because the
/// delay depends on its own fraction f of a sample. Stops if |P| does not cross 1 in one of the
/// ranges. The ranges are those of the initial f, so at least one step succeeds.
double settled_delay_s(const SampledHeadingLoop& loop, const std::vector<Interval>& ranges,
                       double part, double present_s) {
  constexpr int kSteps = 30;
  double delay_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    const std::optional<double> next_s =
        next_crossing_s(CompensatedLoop(loop, part), ranges, present_s);
    if (!next_s) break;
    const double before_s = std::exchange(delay_s, *next_s);
    if (!std::isfinite(delay_s) || is_same_delay(delay_s, before_s, loop)) break;
    part = split_delay(delay_s, loop.sample_time_s).part;
  }
  return delay_s;
}

}  // namespace

double damping_ratio(const SampledHeadingLoop& loop) { return smallest_damping(closed_loop(loop)); }

double speed_damping_ratio(const SampledHeadingLoop& loop) {
  // The first state, psi, acts on no other state if lambda = 0.
  const Eigen::MatrixXd closed = closed_loop(loop);
  const Eigen::Index states = closed.rows() - 1;
  return smallest_damping(closed.bottomRightCorner(states, states));
}

double dominant_damping_ratio(const SampledHeadingLoop& loop) {
  constexpr double kQuick = 20.0;
  const SampledHeadingLoop acting = with_acting_lags(loop);
  const std::vector<Pole> poles = poles_of(acting);
  SampledHeadingLoop unobserved = acting;
  unobserved.observer_radps = 0.0;
  double slowest = std::numeric_limits<double>::infinity();
  for (const Pole& pole : acting.observer_radps > 0.0 ? poles_of(unobserved) : poles) {
    slowest = std::min(slowest, pole.decay);
  }
  double worst = 1.0;
  for (const Pole& pole : poles) {
    const double counted =
        slowest > 0.0 ? std::max(pole.damping, pole.decay / (kQuick * slowest)) : pole.damping;
    worst = std::min(worst, counted);
  }
  return worst;
}

double delay_margin_s(const SampledHeadingLoop& loop) {
  constexpr int kSearches = 10;
  if (!(damping_ratio(loop) > 0.0)) return 0.0;
  const double present_s = loop.command_delay_s;
  double delay_s = std::numeric_limits<double>::infinity();
  double part = 0.0;
  for (int i = 0; i < kSearches; ++i) {
    const std::vector<Interval> ranges = crossings_of(loop, CompensatedLoop(loop, part));
    const double before_s = std::exchange(delay_s, settled_delay_s(loop, ranges, part, present_s));
    if (!std::isfinite(delay_s) || is_same_delay(delay_s, before_s, loop)) break;
    part = split_delay(delay_s, loop.sample_time_s).part;
  }
  return delay_s - present_s;
}

}  // namespace awmr
