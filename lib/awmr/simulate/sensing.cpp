#include "awmr/simulate/sensing.h"

#include <algorithm>
#include <cmath>

namespace awmr {
namespace {

/// Numbers of the random streams of the sensors (RunSeed::random()). The disturbances use other
/// numbers.
enum Use : std::uint64_t { kHeading = 1, kYawRate, kSpeed, kGps };

/// Tolerances for rounding errors of times that should be multiples of the sample time: in samples,
/// and in seconds.
constexpr double kTimeRounding = 1e-9;
constexpr double kTimeRounding_s = 1e-9;

std::size_t whole_samples(double latency_s, double sample_time_s) {
  return static_cast<std::size_t>(latency_s / sample_time_s + kTimeRounding);
}

bool is_noisy(const Channel& channel) { return channel.noise > 0.0 || channel.noise < 0.0; }

/// Returns the reading of a sensor for the true value `truth`: adds bias and noise, and rounds to
/// the quantum. `next_normal` is called only if the sensor has noise.
template <class Normal>
double read(const Channel& channel, double truth, const Normal& next_normal) {
  double value = truth + channel.bias;
  if (is_noisy(channel)) value += channel.noise * next_normal();
  if (channel.quantum > 0.0) value = channel.quantum * std::round(value / channel.quantum);
  return value;
}

}  // namespace

DrawnNoise draw_sensor_noise(const Scenario& scenario, double sample_time_s, std::uint64_t seed,
                             std::uint64_t sample) {
  DrawnNoise noise;
  if (!scenario.sensors) return noise;
  const RunSeed run = run_seed(scenario.seed, seed, sample);
  const std::size_t readings = samples_in(scenario.duration_s, sample_time_s) + 1;
  const auto draw = [&](const Channel& channel, std::uint64_t use, std::vector<double>& normals) {
    if (!is_noisy(channel)) return;
    Random random = run.random(use);
    normals.resize(readings);
    for (double& normal : normals) normal = random.normal();
  };
  draw(scenario.sensors->heading, kHeading, noise.heading);
  draw(scenario.sensors->yaw_rate, kYawRate, noise.yaw_rate);
  draw(scenario.sensors->speed, kSpeed, noise.speed);
  return noise;
}

Sensing::Sensor::Sensor(const Channel& its_channel, double sample_time_s, const Random& its_random,
                        const std::vector<double>* its_normals)
    : channel(its_channel),
      latency(whole_samples(its_channel.latency_s, sample_time_s)),
      part(its_channel.latency_s / sample_time_s - static_cast<double>(latency)),
      correlation(noise_correlation(its_channel.correlation_s, sample_time_s)),
      random(its_random),
      normals(its_normals) {}

double Sensing::Sensor::read(std::size_t k, double truth) {
  return awmr::read(channel, truth, [&] { return next_noise(k); });
}

double Sensing::Sensor::next_noise(std::size_t k) {
  const double normal = normals ? (*normals)[k] : random.normal();
  if (correlation == 0.0) return normal;
  noise =
      k == 0 ? normal : correlation * noise + std::sqrt(1.0 - correlation * correlation) * normal;
  return noise;
}

Sensing::Sensing(const std::optional<Sensors>& sensors, double sample_time_s, const RunSeed& seed,
                 const DrawnNoise* noise)
    : sensors_(sensors),
      sample_time_s_(sample_time_s),
      heading_(sensors ? sensors->heading : Channel{}, sample_time_s, seed.random(kHeading),
               noise ? &noise->heading : nullptr),
      yaw_rate_(sensors ? sensors->yaw_rate : Channel{}, sample_time_s, seed.random(kYawRate),
                noise ? &noise->yaw_rate : nullptr),
      speed_(sensors ? sensors->speed : Channel{}, sample_time_s, seed.random(kSpeed),
             noise ? &noise->speed : nullptr),
      gps_(seed.random(kGps)),
      motion_(2 + std::max({heading_.latency, yaw_rate_.latency, speed_.latency})),
      // Past positions to keep for the fixes. A fix has the position of the last sample before its
      // own time, and arrives at the first sample after its latency.
      kept_(4 + whole_samples(sensors && sensors->gps ? sensors->gps->latency_s : 0.0,
                              sample_time_s)) {}

double Sensing::truth_at(std::size_t k, const Sensor& sensor,
                         double Measurement<double>::*quantity) const {
  const auto at = [&](std::size_t sample) { return motion_[sample % motion_.size()].*quantity; };
  const std::size_t newer = k > sensor.latency ? k - sensor.latency : 0;
  if (newer == 0 || sensor.part <= kTimeRounding) return at(newer);
  return at(newer) + sensor.part * (at(newer - 1) - at(newer));
}

Sensed Sensing::at(std::size_t k, const State<double>& truth) {
  Sensed sensed{{truth.psi_rad, truth.u_mps, truth.v_mps, truth.r_radps}, {truth.x_m, truth.y_m}};
  if (!sensors_) return sensed;
  motion_[k % motion_.size()] = sensed.motion;
  using M = Measurement<double>;
  sensed.motion.psi_rad = heading_.read(k, truth_at(k, heading_, &M::psi_rad));
  sensed.motion.r_radps = yaw_rate_.read(k, truth_at(k, yaw_rate_, &M::r_radps));
  sensed.motion.u_mps = speed_.read(k, truth_at(k, speed_, &M::u_mps));
  if (!sensors_->speed_signed) sensed.motion.u_mps = std::abs(sensed.motion.u_mps);
  if (!sensors_->sway_measured) sensed.motion.v_mps = 0.0;
  if (sensors_->gps) receive_fixes(k, truth, sensed);
  return sensed;
}

/// Sets the measured position to the last fix that has arrived. Before the first fix arrives, it is
/// the true initial position, as if a fix had been taken one GPS period before the start. A fix
/// that is lost in a drop-out also uses random numbers, so that drop-outs do not change the noise
/// of the other fixes.
void Sensing::receive_fixes(std::size_t k, const State<double>& truth, Sensed& sensed) {
  const Gps& gps = *sensors_->gps;
  if (k < kept_) true_m_.emplace_back();
  true_m_[k % kept_] = {truth.x_m, truth.y_m};
  if (k == 0) {
    fix_m_ = true_m_.front();
    fix_taken_s_ = -1.0 / gps.rate_hz;
  }
  const double now_s = static_cast<double>(k) * sample_time_s_ + kTimeRounding_s;
  for (;; ++next_fix_) {
    const double taken_s = static_cast<double>(next_fix_) / gps.rate_hz;
    if (taken_s + gps.latency_s > now_s) break;
    const bool lost = std::any_of(gps.dropouts.begin(), gps.dropouts.end(),
                                  [&](const Window& window) { return window.holds(taken_s); });
    const auto sample = std::min(
        k, static_cast<std::size_t>(std::floor(taken_s / sample_time_s_ + kTimeRounding_s)));
    const auto next_normal = [this] { return gps_.normal(); };
    const Position<double>& true_m = true_m_[sample % kept_];
    const Position<double> fix{read(gps.x, true_m.x_m, next_normal),
                               read(gps.y, true_m.y_m, next_normal)};
    if (lost) continue;
    fix_m_ = fix;
    fix_taken_s_ = static_cast<double>(sample) * sample_time_s_;
    sensed.is_fix_new = true;
  }
  sensed.position_m = fix_m_;
  sensed.fix_taken_s = fix_taken_s_;
}

double fix_noise_m(const Gps& gps) {
  return std::sqrt(gps.x.noise * gps.x.noise + gps.x.quantum * gps.x.quantum / 12.0);
}

Positioning::Positioning(const Scenario& scenario, double sample_time_s) {
  if (!estimates_position(scenario)) return;
  const Gps& gps = *scenario.sensors->gps;
  estimate_.emplace(position_filter<double>(fix_noise_m(gps), gps.latency_s, sample_time_s));
}

Position<double> Positioning::step(double t_s, const Sensed& sensed) {
  if (!estimate_) return sensed.position_m;
  return estimate_->step({sensed.position_m, t_s - sensed.fix_taken_s, sensed.is_fix_new},
                         sensed.motion);
}

}  // namespace awmr
