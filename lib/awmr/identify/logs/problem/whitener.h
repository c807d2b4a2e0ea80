/// Kalman filter that whitens the residuals of a channel: removes their correlation in time.
/// Private to identify/.
#pragma once

#include <algorithm>
#include <cmath>

#include "awmr/identify/logs/problem/channel_noise.h"

namespace awmr {

/// Transition matrix F of a drift over the time h. The drift d is the first component of the state
/// x = (d, d'/omega), whose stationary covariance is P = sigma_d^2 I:
///
///     x <- F x + noise with the covariance P - F P F^T
///
/// For a first-order drift, only f[0][0] = e^(-h/tau) is used. For a second-order drift, with s =
/// zeta omega and nu = omega sqrt(1 - zeta^2),
///
///     F = e^(-s h) ( cos(nu h) + (s/nu) sin(nu h)        (omega/nu) sin(nu h)
///                    -(omega/nu) sin(nu h)               cos(nu h) - (s/nu) sin(nu h) )
///
/// For zeta > 1, cosh and sinh replace cos and sin.
struct DriftStep {
  double f[2][2] = {{0.0, 0.0}, {0.0, 0.0}};

  DriftStep() = default;
  DriftStep(const ChannelNoise& noise, double h_s) {
    if (!noise.second_order()) {
      f[0][0] = std::exp(-h_s / noise.correlation_s);
      return;
    }
    const double omega = noise.frequency_radps;
    const double s = noise.damping * omega;
    const double nu = omega * std::sqrt(std::abs(1.0 - noise.damping * noise.damping));
    double cosine = 0.0;        // e^(-s h) cos(nu h)
    double sine_over_nu = 0.0;  // e^(-s h) sin(nu h)/nu
    if (nu * h_s < 1e-6) {
      cosine = std::exp(-s * h_s);
      sine_over_nu = h_s * cosine;
    } else if (noise.damping < 1.0) {
      cosine = std::exp(-s * h_s) * std::cos(nu * h_s);
      sine_over_nu = std::exp(-s * h_s) * std::sin(nu * h_s) / nu;
    } else {
      const double slow = std::exp(-(s - nu) * h_s);
      const double fast = std::exp(-(s + nu) * h_s);
      cosine = 0.5 * (slow + fast);
      sine_over_nu = 0.5 * (slow - fast) / nu;
    }
    f[0][0] = cosine + s * sine_over_nu;
    f[0][1] = omega * sine_over_nu;
    f[1][0] = -omega * sine_over_nu;
    f[1][1] = cosine - s * sine_over_nu;
  }
};

/// Gains of the Kalman filter for the residuals e of one channel (symbols: ChannelNoise). The state
/// is the drift x with its covariance P; F is the transition matrix (DriftStep). For each residual:
///
///     x = F x,   P = F P F^T + sigma_d^2 (I - F F^T)
///     nu = e - x_0,   S = P_00 + sigma_w^2,   x += (P_.0/S) nu,   P -= P_.0 P_.0^T/S
///
/// With differenced noise, the state is the previous white noise n. Its variance P starts at
/// sigma_w^2:
///
///     nu = e + theta n,   S = sigma_w^2 + theta^2 P,   n = (sigma_w^2/S) nu
///     P = sigma_w^2 (1 - sigma_w^2/S)
///
/// nu/sqrt(S) is white noise if e follows ChannelNoise. This class computes F, S and the gains,
/// which depend only on the times of the residuals, not on their values.
class WhitenerGains {
 public:
  /// `noise` must outlive this object.
  explicit WhitenerGains(const ChannelNoise& noise)
      : noise_(noise),
        p00_(std::pow(noise.differenced > 0.0 ? noise.white_std : noise.drift_std, 2)),
        p11_(p00_) {}

  struct Step {
    bool predicts = false;  ///< true: the state has to be advanced first, x = F x
    bool restarts = false;  ///< true: the state n has to be reset to 0 first (differenced noise)
    double gain0 = 0.0;
    double gain1 = 0.0;
    double variance = 0.0;  ///< S
  };
  /// Advances to the next residual. `since_s`: time since the previous residual, s; 0 for the
  /// first. At a constant interval the gains converge; the class then reuses them, to save time.
  const Step& next(double since_s) {
    if (settled_ && same_step(since_s)) return last_;
    const double white = noise_.white_std * noise_.white_std;
    if (noise_.differenced > 0.0) return next_differenced(white, since_s);
    if (noise_.is_white()) {
      last_.variance = white;
      return last_;
    }
    const Step before = last_;
    last_.predicts = since_s > 0.0;
    if (last_.predicts) predict(since_s);
    last_.variance = p00_ + white;
    last_.gain0 = p00_ / last_.variance;
    last_.gain1 = p01_ / last_.variance;
    settled_ = last_.predicts && before.predicts && near(last_.variance, before.variance) &&
               near(last_.gain0, before.gain0) && near(last_.gain1, before.gain1);
    p11_ -= last_.gain1 * p01_;
    p01_ -= last_.gain0 * p01_;
    p00_ -= last_.gain0 * p00_;
    return last_;
  }
  const DriftStep& drift_step() const { return step_; }
  bool is_white() const { return noise_.is_white(); }
  double differenced() const { return noise_.differenced; }
  bool second_order() const { return noise_.second_order(); }

 private:
  static bool near(double a, double b) { return std::abs(a - b) <= 1e-14 * std::abs(b); }

  /// Computes the gains for differenced noise e_k = n_k - theta n_{k-1}. After a gap of more than
  /// kGap steps the filter restarts, because the last residual before the gap does not have the
  /// noise n_{k-1}.
  const Step& next_differenced(double white, double since_s) {
    constexpr double kGap = 1.5;
    last_.restarts = since_s_ > 0.0 && since_s > kGap * since_s_;
    if (last_.restarts) p00_ = white;
    if (since_s > 0.0 && !last_.restarts) since_s_ = since_s;
    last_.variance = white + noise_.differenced * noise_.differenced * p00_;
    last_.gain0 = white / last_.variance;
    p00_ = white * (1.0 - last_.gain0);
    return last_;
  }

  bool same_step(double since_s) const { return std::abs(since_s - since_s_) <= 1e-6 * since_s; }

  void predict(double since_s) {
    if (!same_step(since_s)) {
      since_s_ = since_s;
      step_ = DriftStep(noise_, since_s);
    }
    const auto& f = step_.f;
    const double drift = noise_.drift_std * noise_.drift_std;
    if (!noise_.second_order()) {
      p00_ = f[0][0] * f[0][0] * p00_ + (1.0 - f[0][0] * f[0][0]) * drift;
      return;
    }
    // Prediction of P in another form. With drift = sigma_d^2 and Q = P - drift I, it is F P F^T +
    // drift (I - F F^T) = drift I + F Q F^T.
    const double q00 = p00_ - drift;
    const double q11 = p11_ - drift;
    const double a0 = f[0][0] * q00 + f[0][1] * p01_;
    const double a1 = f[0][0] * p01_ + f[0][1] * q11;
    const double b0 = f[1][0] * q00 + f[1][1] * p01_;
    const double b1 = f[1][0] * p01_ + f[1][1] * q11;
    // Rounding can make a variance negative.
    p00_ = std::max(drift + a0 * f[0][0] + a1 * f[0][1], 0.0);
    p01_ = a0 * f[1][0] + a1 * f[1][1];
    p11_ = std::max(drift + b0 * f[1][0] + b1 * f[1][1], 0.0);
  }

  const ChannelNoise& noise_;
  double p00_;
  double p01_ = 0.0;
  double p11_;
  double since_s_ = 0.0;
  DriftStep step_;
  Step last_;
  bool settled_ = false;
};

/// State of the Kalman filter for one series of numbers: the errors, or their derivatives with
/// respect to one quantity.
struct WhitenerState {
  double x0 = 0.0;
  double x1 = 0.0;

  /// Returns the innovation nu of the next value.
  double next(double value, const WhitenerGains& gains, const WhitenerGains::Step& step) {
    if (gains.differenced() > 0.0) {
      if (step.restarts) x0 = 0.0;
      const double innovation = value + gains.differenced() * x0;
      x0 = step.gain0 * innovation;
      return innovation;
    }
    const auto& f = gains.drift_step().f;
    if (step.predicts && !gains.second_order()) x0 = f[0][0] * x0;
    if (step.predicts && gains.second_order()) {
      const double before = x0;
      x0 = f[0][0] * before + f[0][1] * x1;
      x1 = f[1][0] * before + f[1][1] * x1;
    }
    const double innovation = value - x0;
    x0 += step.gain0 * innovation;
    if (gains.second_order()) x1 += step.gain1 * innovation;
    return innovation;
  }
};

/// Whitens the errors of one channel in sequence.
class Whitener {
 public:
  /// `noise` must outlive this object.
  explicit Whitener(const ChannelNoise& noise) : gains_(noise) {}

  struct Innovation {
    double value;     ///< nu
    double variance;  ///< S
  };
  /// Returns the innovation of the next error. `since_s`: time since the previous error, s; 0 for
  /// the first.
  Innovation next(double error, double since_s) {
    const WhitenerGains::Step& step = gains_.next(since_s);
    if (gains_.is_white()) return {error, step.variance};
    return {state_.next(error, gains_, step), step.variance};
  }

 private:
  WhitenerGains gains_;
  WhitenerState state_;
};

}  // namespace awmr
