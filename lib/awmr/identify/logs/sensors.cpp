#include "awmr/identify/logs/sensors.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/trials/replay.h"

namespace awmr {
bool SensorTerms::any_delayed() const {
  return std::ranges::any_of(delay, [](const auto& one) { return one.has_value(); });
}

bool SensorTerms::any_smoothed() const {
  return std::ranges::any_of(smoothing, [](const auto& one) { return one.has_value(); });
}

LogSensors::LogSensors(const LogSignals& signals, const SensorTerms& terms, const CommandPath& path,
                       const Plant<double>& plant, const std::vector<ParameterColumn>& parameters,
                       std::size_t columns)
    : signals_(signals),
      terms_(terms),
      path_(path),
      wheels_{plant, parameters, columns_of(path)},
      row_(columns) {}

double LogSensors::read(LogChannel c, const LinearMotion& motion, double t_s) {
  if (!row_.empty()) std::copy_n(motion.row(c, row_.size()), row_.size(), row_.begin());
  double value = channel_of(motion.state, c);
  for (const WheelSlip& slip : terms_.slips) {
    if (slip.channel != c) continue;
    value += add_wheel_slip(slip, wheels_, command_at(signals_, t_s, path_), motion, row_.size(),
                            row_.data());
  }
  if (c == LogChannel::kSway) value = sway(motion);
  return scaled(c, value);
}

/// Multiplies a reading and its derivatives by the scale error of the sensor (sensor_scale_of()).
double LogSensors::scaled(LogChannel c, double value) {
  const auto& scale = terms_.scale[at(c)];
  if (!scale) return value;
  const double factor = 1.0 + scale->value;
  for (double& by : row_) by *= factor;
  if (!row_.empty()) row_[scale->column] += value;
  return factor * value;
}

/// Reading of the sensor of the sway speed, which may be mounted away from the centre of gravity or
/// at an angle (sway_offset()).
double LogSensors::sway(const LinearMotion& motion) {
  const State<double>& s = motion.state;
  const double x = terms_.sway_offset ? terms_.sway_offset->value : 0.0;
  const double angle = terms_.sway_angle ? terms_.sway_angle->value : 0.0;
  const double along = std::sin(angle);
  const double across = std::cos(angle);
  const std::size_t columns = row_.size();
  if (columns > 0 && (terms_.sway_offset || terms_.sway_angle)) {
    const double* const by_u = motion.row(LogChannel::kSpeed, columns);
    const double* const by_r = motion.row(LogChannel::kYawRate, columns);
    for (std::size_t c = 0; c < columns; ++c) {
      row_[c] = across * row_[c] - along * by_u[c] + x * by_r[c];
    }
    if (terms_.sway_offset) row_[terms_.sway_offset->column] += s.r_radps;
    if (terms_.sway_angle) {
      row_[terms_.sway_angle->column] -= along * s.v_mps + across * s.u_mps;
    }
  }
  return across * s.v_mps - along * s.u_mps + x * s.r_radps;
}

}  // namespace awmr
