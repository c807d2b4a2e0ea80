/// Wheel forces of motors whose commands a controller ramps up or down (soft start), and their
/// derivatives for a log fit. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Times that describe the path from a command to the force of its motor.
struct RampTimes {
  double rise_s = 0.0;  ///< T_r, time in which the magnitude of a force rises by F_max; 0: no limit
  double fall_s = 0.0;  ///< T_f, time in which it falls by F_max; 0: no limit
  double lag_s = 0.0;   ///< T, time constant of the motor behind the ramps; 0: no lag
  /// True: the fall to 0 before a change of the sign is as slow as a rise (T_r, not T_f).
  bool turns_slowly = false;
};

/// Areas of the impulses in the derivatives of the forces with respect to T_r and T_f, at a jump of
/// the forces (T_r = T_f = 0).
struct RampImpulses {
  SideForces<double> by_rise{};
  SideForces<double> by_fall{};
};
/// `turns_slowly`: as in RampTimes.
RampImpulses ramp_impulses(const SideForces<double>& before, const SideForces<double>& after,
                           bool turns_slowly);

/// Forces F' of motors with ramps and a first-order lag. The ramped command c follows the logged
/// command m: its magnitude rises at most at the rate 1/T_r, and falls at most at the rate 1/T_f. A
/// change of its sign is a fall to 0 and then a rise. c is piecewise linear, so the force of the
/// motor behind it follows exactly. With c = c_k + s (t - t_k):
///
///     T dF'/dt = c - F',   F'(t) = c - s T + (F'(t_k) - c_k + s T) exp(-(t - t_k)/T)
///     mean over [t, t + h] = mean of c - (T/h) (F'(t + h) - F'(t))
///
/// At T_r = 0, c jumps by D at t_k. The derivative of c with respect to T_r is then an impulse of
/// the area -D |D|/2; the same holds for T_f. If the time of the jump depends on T_r or T_f, with
/// the derivative t_k', the impulse has the additional area -D t_k'.
///
/// The computation starts with F' = c = m well before the first requested row, or at the log's
/// first row.
class RampedForces {
 public:
  /// Covers the rows [begin, end) of the log, and command delays from -1 to 1 s.
  RampedForces(const DrivingLog& log, std::size_t begin, std::size_t end, const RampTimes& times);

  /// Mean forces over a time span, and their derivatives, 1/s.
  struct Mean {
    SideForces<double> force{};
    SideForces<double> by_rise{};
    SideForces<double> by_fall{};
    SideForces<double> by_lag{};
    SideForces<double> by_delay{};
  };
  /// Computes the mean forces over [t, t + h] if the commands reach the motors `delay_s` after they
  /// were logged.
  Mean mean(double t_s, double h_s, double delay_s) const;
  const RampTimes& times() const { return times_; }

  /// A quantity, and its derivatives with respect to T_r and T_f.
  using WithDerivatives = Eigen::Array3d;

  /// Start of a piece of c. At a jump, the values are those after the jump.
  struct Knot {
    double t_s;
    WithDerivatives command;   ///< c
    WithDerivatives slope;     ///< s, 1/s
    WithDerivatives integral;  ///< integral of c from the first knot, s
    WithDerivatives force;     ///< F'
    double by_lag;             ///< derivative of F' with respect to T, 1/s
  };

 private:
  void add_mean(const std::vector<Knot>& knots, double from_s, double h_s,
                double SideForces<double>::*side, Mean& mean) const;

  RampTimes times_;
  std::vector<Knot> left_;
  std::vector<Knot> right_;
};

}  // namespace awmr
