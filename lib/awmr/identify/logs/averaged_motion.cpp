#include "awmr/identify/logs/averaged_motion.h"

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

}  // namespace

double averaging_time_s(const TermColumn& averaging) {
  return std::max(averaging.value, kShortestMean_s);
}

LinearMotion averaged_motion(const LinearMotion& begin, LinearMotion end,
                             const TermColumn& averaging, std::size_t columns) {
  const double per_s = 1.0 / averaging_time_s(averaging);
  const double turn_rad = end.state.psi_rad - begin.state.psi_rad;
  const double heading_rad = 0.5 * (begin.state.psi_rad + end.state.psi_rad);
  const double cosine = std::cos(heading_rad);
  const double sine = std::sin(heading_rad);
  const double dx_m = end.state.x_m - begin.state.x_m;
  const double dy_m = end.state.y_m - begin.state.y_m;
  const double along_m = dx_m * cosine + dy_m * sine;
  const double across_m = dy_m * cosine - dx_m * sine;
  const ArcPerChord arc(turn_rad);
  const double twelfth_s = 1.0 / (12.0 * per_s);
  const State<double> first = begin.state;
  const State<double> last = end.state;
  const double sideways = first.v_mps * last.r_radps - last.v_mps * first.r_radps;
  const double chord_mps = along_m * per_s - twelfth_s * sideways;
  end.state.u_mps = arc.value * chord_mps;
  end.state.r_radps = turn_rad * per_s;
  for (std::size_t c = 0; c < columns; ++c) {
    const auto of_begin = [&](LogChannel channel) { return begin.row(channel, columns)[c]; };
    const auto of_end = [&](LogChannel channel) { return end.row(channel, columns)[c]; };
    const double along_by =
        cosine * (of_end(LogChannel::kX) - of_begin(LogChannel::kX)) +
        sine * (of_end(LogChannel::kY) - of_begin(LogChannel::kY)) +
        across_m * 0.5 * (of_end(LogChannel::kHeading) + of_begin(LogChannel::kHeading));
    const double turn_by = of_end(LogChannel::kHeading) - of_begin(LogChannel::kHeading);
    const double sideways_by =
        of_begin(LogChannel::kSway) * last.r_radps + first.v_mps * of_end(LogChannel::kYawRate) -
        of_end(LogChannel::kSway) * first.r_radps - last.v_mps * of_begin(LogChannel::kYawRate);
    end.row(LogChannel::kSpeed, columns)[c] =
        arc.value * (per_s * along_by - twelfth_s * sideways_by) +
        arc.by_turn * turn_by * chord_mps;
    end.row(LogChannel::kYawRate, columns)[c] = per_s * turn_by;
  }
  if (columns > 0) {
    end.row(LogChannel::kSpeed, columns)[averaging.column] -=
        arc.value * (per_s * per_s * along_m + sideways / 12.0);
    end.row(LogChannel::kYawRate, columns)[averaging.column] -= per_s * end.state.r_radps;
  }
  return end;
}

}  // namespace awmr
