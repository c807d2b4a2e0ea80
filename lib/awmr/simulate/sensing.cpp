#include "awmr/simulate/sensing.h"

#include <algorithm>
#include <cmath>

namespace awmr {
namespace {

/// Streams of RunSeed::random, apart from those of the disturbances.
enum Use : std::uint64_t { kHeading = 1, kYawRate, kSpeed, kGps };

/// Room for the rounding of times that are multiples of the sample time.
constexpr double kTimeRounding_s = 1e-9;

double read(const Channel& channel, double truth, Random& random) {
  double value = truth + channel.bias;
  if (channel.noise > 0.0 || channel.noise < 0.0) value += channel.noise * random.normal();
  if (channel.quantum > 0.0) value = channel.quantum * std::round(value / channel.quantum);
  return value;
}

}  // namespace

Sensing::Sensing(const std::optional<Sensors>& sensors, double sample_time_s, const RunSeed& seed)
    : sensors_(sensors),
      sample_time_s_(sample_time_s),
      heading_(seed.random(kHeading)),
      yaw_rate_(seed.random(kYawRate)),
      speed_(seed.random(kSpeed)),
      gps_(seed.random(kGps)) {}

Sensed Sensing::at(std::size_t k, const State<double>& truth) {
  Sensed sensed{{truth.psi_rad, truth.u_mps, truth.v_mps, truth.r_radps}, {truth.x_m, truth.y_m}};
  if (!sensors_) return sensed;
  motion_.push_back(sensed.motion);
  sensed.motion.psi_rad = read(sensors_->heading, as_of(sensors_->heading, k).psi_rad, heading_);
  sensed.motion.r_radps = read(sensors_->yaw_rate, as_of(sensors_->yaw_rate, k).r_radps, yaw_rate_);
  sensed.motion.u_mps = read(sensors_->speed, as_of(sensors_->speed, k).u_mps, speed_);
  if (!sensors_->speed_signed) sensed.motion.u_mps = std::abs(sensed.motion.u_mps);
  if (!sensors_->sway_measured) sensed.motion.v_mps = 0.0;
  if (sensors_->gps) sensed.position_m = navigate(k, truth, sensed.motion);
  return sensed;
}

/// The motion that a sensor tells of at the k-th sample; before the first one, that of the first.
const Measurement<double>& Sensing::as_of(const Channel& channel, std::size_t k) const {
  const auto late = static_cast<std::size_t>(std::lround(channel.late_s / sample_time_s_));
  return motion_[k > late ? k - late : 0];
}

/// Dead reckoning from the measured motion; a fix that arrives at t for the time t - latency sets
/// it right by what dead reckoning was off then. The first position is known.
Position<double> Sensing::navigate(std::size_t k, const State<double>& truth,
                                   const Measurement<double>& motion) {
  const Gps& gps = *sensors_->gps;
  true_m_.push_back({truth.x_m, truth.y_m});
  if (k == 0) {
    travelled_m_.push_back({0.0, 0.0});
    fix_offset_m_ = true_m_.front();
  }
  const double now_s = static_cast<double>(k) * sample_time_s_ + kTimeRounding_s;
  for (;; ++next_fix_) {
    const double taken_s = static_cast<double>(next_fix_) / gps.rate_hz;
    if (taken_s + gps.latency_s > now_s) break;
    const bool lost = std::any_of(gps.dropouts.begin(), gps.dropouts.end(),
                                  [&](const Window& window) { return window.holds(taken_s); });
    const auto sample = std::min(
        k, static_cast<std::size_t>(std::floor(taken_s / sample_time_s_ + kTimeRounding_s)));
    const Position<double> fix{read(gps.x, true_m_[sample].x_m, gps_),
                               read(gps.y, true_m_[sample].y_m, gps_)};
    if (lost) continue;
    fix_offset_m_ = {fix.x_m - travelled_m_[sample].x_m, fix.y_m - travelled_m_[sample].y_m};
  }
  const Position<double> travelled = travelled_m_[k];
  const double cos_psi = std::cos(motion.psi_rad);
  const double sin_psi = std::sin(motion.psi_rad);
  travelled_m_.push_back(
      {travelled.x_m + sample_time_s_ * (motion.u_mps * cos_psi - motion.v_mps * sin_psi),
       travelled.y_m + sample_time_s_ * (motion.u_mps * sin_psi + motion.v_mps * cos_psi)});
  return {travelled.x_m + fix_offset_m_.x_m, travelled.y_m + fix_offset_m_.y_m};
}

}  // namespace awmr
