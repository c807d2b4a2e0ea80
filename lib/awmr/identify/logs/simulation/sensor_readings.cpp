#include "awmr/identify/logs/simulation/sensor_readings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/identify/logs/simulation/averaged_motion.h"
#include "awmr/identify/logs/simulation/linear_replay.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// Part of the deviation of a compass: its coefficient `kind` times sin(n psi + phase).
struct Deviation {
  Kind kind;
  double n;
  double phase_rad;

  double angle(double heading_rad) const { return n * heading_rad + phase_rad; }
};
constexpr Deviation kDeviations[] = {{Kind::kCompassSin, 1.0, 0.0},
                                     {Kind::kCompassCos, 1.0, std::numbers::pi / 2.0},
                                     {Kind::kCompassSin2, 2.0, 0.0},
                                     {Kind::kCompassCos2, 2.0, std::numbers::pi / 2.0}};

}  // namespace

void ReadingSeries::add(double value, const std::vector<double>& row) {
  values_.push_back(value);
  append(rows_, row);
}

double ReadingSeries::read(std::size_t i, const std::optional<Smoothing>& smoothing,
                           std::vector<double>& row) const {
  const std::size_t columns = row.size();
  const double* const middle = rows_.data() + i * columns;
  std::copy_n(middle, columns, row.begin());
  if (!smoothing) return values_[i];
  const auto& [weight, by_variance] = smoothing->kernel;
  double value = values_[i];
  double by = 0.0;
  const std::size_t reach = std::min({weight.size() - 1, i, values_.size() - 1 - i});
  for (std::size_t n = 1; n <= reach; ++n) {
    const double bend = values_[i - n] - 2.0 * values_[i] + values_[i + n];
    value += weight[n] * bend;
    by += by_variance[n] * bend;
    const double* const before = middle - n * columns;
    const double* const after = middle + n * columns;
    for (std::size_t k = 0; k < columns; ++k) {
      row[k] += weight[n] * (before[k] - 2.0 * middle[k] + after[k]);
    }
  }
  if (columns > 0) row[smoothing->column] += by * smoothing->rows2_per_s2;
  return value;
}

SensorReadings::SensorReadings(const LogModel& model, const FitWindow& window,
                               const SimulatedVehicle& vehicle, std::size_t columns)
    : model_(model),
      window_(window),
      vehicle_(vehicle),
      terms_(vehicle.sensors),
      wheels_{vehicle.plant, vehicle.parameters, vehicle.path.terms},
      back_(vehicle.plant, columns, vehicle.parameters, vehicle.path.terms, model.longest_step_s,
            vehicle.extra),
      row_(columns) {
  for (const LogChannel c : kChannels) {
    std::optional<SensorFilter> filter = terms_.lag[at(c)];
    if (!filter) continue;
    filter->damping = terms_.lag_damping[at(c)];
    filters_[at(c)].emplace(*filter, channel_of(window.measured, c), columns);
  }
}

double SensorReadings::reading_of(LogChannel c, const LinearMotion& motion, double t_s) {
  if (!row_.empty()) std::copy_n(motion.row(c, row_.size()), row_.size(), row_.begin());
  double value = channel_of(motion.state, c);
  for (const WheelSlip& slip : terms_.slips) {
    if (slip.channel != c) continue;
    value += add_wheel_slip(slip, wheels_, command_at(*window_.signals, t_s, vehicle_.path), motion,
                            row_.size(), row_.data());
  }
  if (c == LogChannel::kSway) value = sway(motion);
  if (c == LogChannel::kSpeed) value += add_speed_offset(motion);
  if (c == LogChannel::kX || c == LogChannel::kY) value += add_antenna(c, motion);
  if (c == LogChannel::kHeading) value += add_deviation(value);
  return scaled(c, value);
}

double SensorReadings::scaled(LogChannel c, double value) {
  const auto& scale = terms_.scale[at(c)];
  if (!scale) return value;
  const double factor = 1.0 + scale->value;
  for (double& by : row_) by *= factor;
  if (!row_.empty()) row_[scale->column] += value;
  return factor * value;
}

/// Part -y_s r of the reading of a speed sensor that is not on the centre line
/// (FreeQuantity::Kind::kSpeedOffset). Adds its derivatives to the row.
double SensorReadings::add_speed_offset(const LinearMotion& motion) {
  const auto& offset = terms_.mounting[Kind::kSpeedOffset];
  if (!offset) return 0.0;
  const double r = motion.state.r_radps;
  if (!row_.empty()) {
    const double* const by_r = motion.row(LogChannel::kYawRate, row_.size());
    for (std::size_t c = 0; c < row_.size(); ++c) row_[c] -= offset->value * by_r[c];
    row_[offset->column] -= r;
  }
  return -offset->value * r;
}

/// Distance along x or y (channel c) from the centre of gravity to the antenna or marker
/// (FreeQuantity::Kind::kPositionAhead). Adds its derivatives to the row.
double SensorReadings::add_antenna(LogChannel c, const LinearMotion& motion) {
  const auto& ahead = terms_.mounting[Kind::kPositionAhead];
  const auto& left = terms_.mounting[Kind::kPositionLeft];
  if (!ahead && !left) return 0.0;
  const double sine = std::sin(motion.state.psi_rad);
  const double cosine = std::cos(motion.state.psi_rad);
  const bool is_x = c == LogChannel::kX;
  const double by_ahead = is_x ? cosine : sine;
  const double by_left = is_x ? -sine : cosine;
  const double x_m = terms_.mounting.value(Kind::kPositionAhead);
  const double y_m = terms_.mounting.value(Kind::kPositionLeft);
  if (!row_.empty()) {
    const double by_heading = is_x ? -x_m * sine - y_m * cosine : x_m * cosine - y_m * sine;
    const double* const heading_by = motion.row(LogChannel::kHeading, row_.size());
    for (std::size_t i = 0; i < row_.size(); ++i) row_[i] += by_heading * heading_by[i];
    if (ahead) row_[ahead->column] += by_ahead;
    if (left) row_[left->column] += by_left;
  }
  return x_m * by_ahead + y_m * by_left;
}

/// Deviation B sin psi + C cos psi + D sin 2 psi + E cos 2 psi of a compass
/// (FreeQuantity::Kind::kCompassSin). Adds its derivatives to the row, the derivatives of psi.
double SensorReadings::add_deviation(double heading_rad) {
  const auto is_free = [&](const Deviation& part) {
    return terms_.mounting[part.kind].has_value();
  };
  if (std::ranges::none_of(kDeviations, is_free)) return 0.0;
  double deviation = 0.0;
  double by_heading = 1.0;
  for (const Deviation& part : kDeviations) {
    const double value = terms_.mounting.value(part.kind);
    deviation += value * std::sin(part.angle(heading_rad));
    by_heading += value * part.n * std::cos(part.angle(heading_rad));
  }
  for (double& by : row_) by *= by_heading;
  for (const Deviation& part : kDeviations) {
    const auto& term = terms_.mounting[part.kind];
    if (term && !row_.empty()) row_[term->column] += std::sin(part.angle(heading_rad));
  }
  return deviation;
}

/// Reading of the sensor of the sway speed, which may sit off the centre of gravity or at an angle
/// (FreeQuantity::Kind::kSwayOffset).
double SensorReadings::sway(const LinearMotion& motion) {
  const State<double>& s = motion.state;
  const auto& offset = terms_.mounting[Kind::kSwayOffset];
  const auto& turned = terms_.mounting[Kind::kSwayAngle];
  const double x = terms_.mounting.value(Kind::kSwayOffset);
  const double angle = terms_.mounting.value(Kind::kSwayAngle);
  const double along = std::sin(angle);
  const double across = std::cos(angle);
  const std::size_t columns = row_.size();
  if (columns > 0 && (offset || turned)) {
    const double* const by_u = motion.row(LogChannel::kSpeed, columns);
    const double* const by_r = motion.row(LogChannel::kYawRate, columns);
    for (std::size_t c = 0; c < columns; ++c) {
      row_[c] = across * row_[c] - along * by_u[c] + x * by_r[c];
    }
    if (offset) row_[offset->column] += s.r_radps;
    if (turned) row_[turned->column] -= along * s.v_mps + across * s.u_mps;
  }
  return across * s.v_mps - along * s.u_mps + x * s.r_radps;
}

void SensorReadings::go_on(const LinearMotion& now) {
  const std::vector<double>& t_s = window_.rows.log->t_s;
  const std::size_t row = window_.rows.begin + rows_;
  const double since_s = rows_ > 0 ? t_s[row] - t_s[row - 1] : 0.0;
  ++rows_;
  if (terms_.any_earlier()) motions_.push_back(now);
  for (const LogChannel c : kChannels) {
    if (!filters_[at(c)]) continue;
    const double input = reading_of(c, now, t_s[row]);
    filters_[at(c)]->next(input, row_.data(), since_s, row_.size());
  }
}

LinearMotion SensorReadings::earlier(const TermColumn& before_s) {
  return earlier_motion(*window_.signals, window_.rows.begin, motions_, back_, before_s,
                        model_.longest_step_s, vehicle_.path);
}

LinearMotion SensorReadings::averaged(LogChannel c, LinearMotion end, double late_s) {
  const TermColumn& averaging = *terms_.averaging[at(c)];
  LinearMotion begin = earlier({late_s + averaging_time_s(averaging), averaging.column});
  // The motion of the vehicle does not depend on the averaging time, so its column holds only the
  // derivatives with respect to the time of `begin`, on which the latency has the same effect.
  const auto& delay = terms_.delay[at(c)];
  const std::size_t columns = row_.size();
  for (std::size_t i = 0; columns > 0 && delay && i < kStateSize; ++i) {
    double* const by = begin.by_column.data() + i * columns;
    by[delay->column] += by[averaging.column];
  }
  return averaged_motion(begin, std::move(end), averaging, columns);
}

double SensorReadings::read(LogChannel c, const LinearMotion& now) {
  if (const auto& filter = filters_[at(c)]) {
    row_ = filter->by_column();
    return filter->value();
  }
  const double t_s = window_.rows.log->t_s[window_.rows.begin + rows_ - 1];
  const auto& delay = terms_.delay[at(c)];
  const bool is_mean = terms_.averaging[at(c)].has_value();
  if (!delay && !is_mean) return reading_of(c, now, t_s);
  const double late_s = delay ? delay->value : 0.0;
  LinearMotion then = delay ? earlier(*delay) : now;
  if (is_mean) then = averaged(c, std::move(then), late_s);
  return reading_of(c, then, t_s - late_s);
}

}  // namespace awmr
