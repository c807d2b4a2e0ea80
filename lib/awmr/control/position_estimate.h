/// Estimate of the vehicle's position from GPS fixes, which have noise and latency, and from the
/// measured motion.
///
/// Between fixes, the position p follows the dead-reckoned displacement D (heading psi, surge speed
/// u, sway speed v, sample time T_s). c is the correction applied so far:
///   p  = D + c
///   D += T_s (u cos psi - v sin psi, u sin psi + v cos psi)
/// A fix z that was taken `age_s` ago is compared with the D of that time, which a ring buffer
/// stores. A Kalman filter estimates the offset o of the true position from D. P is the variance of
/// o on each axis, R the variance of a fix, q the growth of the variance per second:
///   P += q t                        t: time since the previous fix
///   K  = P/(P + R),   nu = z - D(age_s ago) - o
///   o   += K nu,   P -= K P
/// The first fix sets P = R, so that the first fixes are averaged. After each fix, c changes
/// linearly to o within kSpread_s, so that the direction to a near waypoint does not jump.
///
/// A fix is rejected if |nu| > kInnovationMax sqrt(P + R). After kRejections rejected fixes in a
/// row, the estimate itself must be wrong: it is reset to the last fix, and `resets` counts this.
/// In the firmware, emit/board/gps_check.h has already refused each fix that the vehicle cannot
/// have reached.
#pragma once

#include <stdint.h>

#include "awmr/control/measurement.h"
#include "awmr/control/position_filter.h"
#include "awmr/model/quick_sin.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Estimates the position. `Filter`: PositionFilter, or a type with constants of the same names.
template <class T, class Filter = PositionFilter<T>>
class PositionEstimate {
 public:
  uint8_t resets = 0;  ///< number of resets since the start, up to 255

  constexpr explicit PositionEstimate(const Filter& filter = Filter()) : filter_(filter) {}

  /// Makes the estimate start anew in the next step, from the fix of that step.
  void restart() { is_started_ = false; }

  /// Returns the present position; in the first step, and in the first step after restart(), the
  /// position of the fix. Call it once per step, with the last fix and the measured motion. A fix
  /// that arrives while the previous fix is being processed is dropped.
  Position<T> step(const PositionFix<T>& fix, const Measurement<T>& m) {
    if (!is_started_) {
      start(fix.position_m);
    } else {
      travel(m);
      if (fix.is_new && work_ == 0) take(fix);
    }
    if (steps_left_ > 0) follow();
    while (work_ > 0) {
      work(work_--);
      if (filter_.spreads_work) break;
    }
    return {travelled_m_.x_m + shown_m_.x_m, travelled_m_.y_m + shown_m_.y_m};
  }

 private:
  /// If the work is spread over several steps, a fix takes kWorkSteps steps. They begin kWait steps
  /// after its arrival, because GpsReceiver uses these kWait steps for its checks.
  static constexpr uint8_t kWorkSteps = 4;
  static constexpr uint8_t kWait = 5;

  Filter filter_;
  Position<T> travelled_m_ = {};         // D: dead-reckoned displacement
  Position<T> step_m_ = {};              // increment of D per step
  Position<T> direction_ = {};           // (cos psi, sin psi)
  Position<T> offset_m_ = {};            // o: estimated offset
  Position<T> shown_m_ = {};             // c: applied correction
  Position<T> follow_m_ = {};            // increment of c per step
  Position<T> innovation_m_ = {};        // z, then nu
  Position<T> ring_m_[kTravelled] = {};  // D every `stride` steps
  // Age of the fix z, s. locate() replaces the age by a fraction: the time of z between two
  // elements of the ring, 0 at newer_, 1 at the next older element.
  T age_s_ = T(0.0);
  T variance_m2_ = T(0.0);  // P: variance of o
  uint16_t steps_ = 0;      // steps since a fix was last processed
  uint8_t since_ = 0;       // steps since the newest element was stored
  uint8_t newest_ = 0;      // index of the newest element
  uint8_t newer_ = 0;       // index of the first element that is newer than the fix z
  uint8_t phase_ = 0;       // next of the three parts of travel(): 0, 1 or 2
  uint8_t work_ = 0;        // steps left until the fix is processed; 0: there is no fix
  uint8_t steps_left_ = 0;  // steps until c equals o
  uint8_t rejected_ = 0;    // fixes rejected in a row
  bool is_started_ = false;

  void start(const Position<T>& position_m) {
    const Filter filter = filter_;
    const uint8_t before = resets;
    *this = PositionEstimate(filter);
    resets = before;
    variance_m2_ = filter_.fix_variance_m2;
    offset_m_ = shown_m_ = position_m;
    is_started_ = true;
  }

  /// Adds the motion of one step to the displacement D. If the work is spread over several steps,
  /// each step updates one of three values in turn: cos psi, sin psi, the increment of D.
  void travel(const Measurement<T>& m) {
    if (phase_ == 0 || !filter_.spreads_work) direction_.x_m = math::quick_cos(m.psi_rad);
    if (phase_ == 1 || !filter_.spreads_work) direction_.y_m = math::quick_sin(m.psi_rad);
    if (phase_ == 2 || !filter_.spreads_work) {
      const T ahead_m = filter_.sample_time_s * m.u_mps;
      const T left_m = math::is_zero(m.v_mps) ? m.v_mps : filter_.sample_time_s * m.v_mps;
      step_m_.x_m = math::plus_product(T(ahead_m * direction_.x_m), T(-direction_.y_m), left_m);
      step_m_.y_m = math::plus_product(T(ahead_m * direction_.y_m), direction_.x_m, left_m);
    }
    phase_ = static_cast<uint8_t>(phase_ == 2 ? 0 : phase_ + 1);
    travelled_m_.x_m += step_m_.x_m;
    travelled_m_.y_m += step_m_.y_m;
    if (steps_ < 0xFFFF) ++steps_;
    if (++since_ < filter_.stride) return;
    since_ = 0;
    newest_ = index_of(newest_ + 1);
    ring_m_[newest_] = travelled_m_;
  }

  void take(const PositionFix<T>& fix) {
    innovation_m_ = fix.position_m;
    age_s_ = fix.age_s;
    work_ = filter_.spreads_work ? kWait + kWorkSteps : kWorkSteps;
  }

  void work(uint8_t left) {
    if (left == 4) locate();
    if (left == 3) innovate();
    if (left == 2 && !is_accepted()) work_ = 0;
    if (left == 1) correct();
  }

  /// Finds the ring elements before and after the time of the fix. For a fix younger than the
  /// newest element, D is extrapolated. The oldest element is not used, because travel() can
  /// overwrite it before the next step of the work.
  void locate() {
    const T waited = filter_.spreads_work ? T(kWait) : T(0.0);
    const T steps = age_s_ * filter_.sample_rate_hz + (waited - T(since_));
    age_s_ = math::clamp(T(steps * filter_.stride_inverse), T(-1.0), T(kTravelled - 2));
    uint8_t elements = age_s_ > T(0.0) ? static_cast<uint8_t>(age_s_) : 0;
    if (elements > kTravelled - 3) elements = kTravelled - 3;
    age_s_ -= T(elements);
    newer_ = index_of(newest_ - elements);
  }

  void innovate() {
    const Position<T>& newer = ring_m_[newer_];
    const Position<T>& older = ring_m_[index_of(newer_ - 1)];
    innovation_m_.x_m -= offset_m_.x_m + (newer.x_m + (older.x_m - newer.x_m) * age_s_);
    innovation_m_.y_m -= offset_m_.y_m + (newer.y_m + (older.y_m - newer.y_m) * age_s_);
    variance_m2_ += T(steps_) * filter_.drift_m2;
    steps_ = 0;
  }

  static uint8_t index_of(int element) { return static_cast<uint8_t>(element) % kTravelled; }

  bool is_accepted() {
    const T square_m2 =
        innovation_m_.x_m * innovation_m_.x_m + innovation_m_.y_m * innovation_m_.y_m;
    const T largest_m2 =
        T(kInnovationMax * kInnovationMax) * (variance_m2_ + filter_.fix_variance_m2);
    if (!math::is_beyond(square_m2, largest_m2)) {
      rejected_ = 0;
      return true;
    }
    if (++rejected_ < kRejections) return false;
    rejected_ = 0;
    if (resets < 255) ++resets;
    variance_m2_ = filter_.fix_variance_m2;
    offset_m_.x_m += innovation_m_.x_m;
    offset_m_.y_m += innovation_m_.y_m;
    shown_m_ = offset_m_;
    steps_left_ = 0;
    return false;
  }

  void correct() {
    const T gain = variance_m2_ / (variance_m2_ + filter_.fix_variance_m2);
    variance_m2_ -= gain * variance_m2_;
    offset_m_.x_m += gain * innovation_m_.x_m;
    offset_m_.y_m += gain * innovation_m_.y_m;
    follow_m_.x_m = (offset_m_.x_m - shown_m_.x_m) * filter_.spread_inverse;
    follow_m_.y_m = (offset_m_.y_m - shown_m_.y_m) * filter_.spread_inverse;
    steps_left_ = filter_.spread_steps;
  }

  void follow() {
    --steps_left_;
    shown_m_.x_m += follow_m_.x_m;
    shown_m_.y_m += follow_m_.y_m;
  }
};

}  // namespace awmr
