#include "awmr/identify/logs/simulation/averaged_motion.h"

#include <algorithm>
#include <cmath>

namespace awmr {
namespace {

constexpr double kShortestMean_s = 1e-4;

/// (a/2)/sin(a/2) as a series, and its derivative with respect to a.
struct ArcPerChord {
  explicit ArcPerChord(double turn_rad) {
    const double half = 0.5 * turn_rad;
    const double square = half * half;
    value = 1.0 + square / 6.0 + 7.0 * square * square / 360.0;
    by_turn = half / 6.0 + 7.0 * half * square / 180.0;
  }
  double value;
  double by_turn;
};

/// Terms of the mean speed from one state to another (averaged_motion.h).
struct MeanSpeed {
  MeanSpeed(const State<double>& first, const State<double>& last, double averaging_s)
      : per_s(1.0 / averaging_s),
        twelfth_s(1.0 / (12.0 * per_s)),
        cosine(std::cos(0.5 * (first.psi_rad + last.psi_rad))),
        sine(std::sin(0.5 * (first.psi_rad + last.psi_rad))),
        along_m((last.x_m - first.x_m) * cosine + (last.y_m - first.y_m) * sine),
        across_m((last.y_m - first.y_m) * cosine - (last.x_m - first.x_m) * sine),
        sideways(first.v_mps * last.r_radps - last.v_mps * first.r_radps),
        arc(last.psi_rad - first.psi_rad),
        chord_mps(along_m * per_s - twelfth_s * sideways) {}

  double per_s;         ///< 1/L
  double twelfth_s;     ///< L/12
  double cosine, sine;  ///< of the mean heading p
  double along_m;       ///< distance along p
  double across_m;      ///< distance to the left of it
  double sideways;      ///< v r' - v' r
  ArcPerChord arc;
  double chord_mps;  ///< mean speed without the ratio of arc and chord
};

/// Sets the derivatives of the mean speed and the mean yaw rate of `mean` with respect to the
/// columns. `last`: the state at the end. The other derivatives of `mean` are those at the end.
void set_derivatives(const LinearMotion& begin, const MeanSpeed& speed, const State<double>& last,
                     std::size_t columns, LinearMotion& mean) {
  const State<double>& first = begin.state;
  for (std::size_t c = 0; c < columns; ++c) {
    const auto of_begin = [&](LogChannel channel) { return begin.row(channel, columns)[c]; };
    const auto of_end = [&](LogChannel channel) { return mean.row(channel, columns)[c]; };
    const double along_by =
        speed.cosine * (of_end(LogChannel::kX) - of_begin(LogChannel::kX)) +
        speed.sine * (of_end(LogChannel::kY) - of_begin(LogChannel::kY)) +
        speed.across_m * 0.5 * (of_end(LogChannel::kHeading) + of_begin(LogChannel::kHeading));
    const double turn_by = of_end(LogChannel::kHeading) - of_begin(LogChannel::kHeading);
    const double sideways_by =
        of_begin(LogChannel::kSway) * last.r_radps + first.v_mps * of_end(LogChannel::kYawRate) -
        of_end(LogChannel::kSway) * first.r_radps - last.v_mps * of_begin(LogChannel::kYawRate);
    mean.row(LogChannel::kSpeed, columns)[c] =
        speed.arc.value * (speed.per_s * along_by - speed.twelfth_s * sideways_by) +
        speed.arc.by_turn * turn_by * speed.chord_mps;
    mean.row(LogChannel::kYawRate, columns)[c] = speed.per_s * turn_by;
  }
}

}  // namespace

double averaging_time_s(const TermColumn& averaging) {
  return std::max(averaging.value, kShortestMean_s);
}

LinearMotion averaged_motion(const LinearMotion& begin, LinearMotion end,
                             const TermColumn& averaging, std::size_t columns) {
  const State<double> last = end.state;
  const MeanSpeed speed(begin.state, last, averaging_time_s(averaging));
  end.state.u_mps = speed.arc.value * speed.chord_mps;
  end.state.r_radps = (last.psi_rad - begin.state.psi_rad) * speed.per_s;
  set_derivatives(begin, speed, last, columns, end);
  if (columns > 0) {
    end.row(LogChannel::kSpeed, columns)[averaging.column] -=
        speed.arc.value * (speed.per_s * speed.per_s * speed.along_m + speed.sideways / 12.0);
    end.row(LogChannel::kYawRate, columns)[averaging.column] -= speed.per_s * end.state.r_radps;
  }
  return end;
}

}  // namespace awmr
