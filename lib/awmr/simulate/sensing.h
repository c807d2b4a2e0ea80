/// Sensor models: sampling, delay, bias, noise and quantisation of the measurements, and the
/// position that the guidance gets from them. Private to this folder.
#pragma once

#include <optional>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/control/guidance/waypoints.h"
#include "awmr/control/position_estimate.h"
#include "awmr/model/state.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/disturbance.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Measurements of one sample, with all sensor errors.
struct Sensed {
  Measurement<double> motion;
  Position<double> position_m;  ///< last fix that has arrived; without a GPS, the true position
  double fix_taken_s = 0.0;     ///< time at which the fix was taken; < 0 before the first fix
  bool is_fix_new = false;      ///< the fix arrived since the previous sample
};

/// The sensors of one run, with their noise and latency.
class Sensing {
 public:
  /// `noise`: the result of draw_sensor_noise() for this seed, or null. It must outlive the
  /// sensors.
  Sensing(const std::optional<Sensors>& sensors, double sample_time_s, const RunSeed& seed,
          const DrawnNoise* noise = nullptr);
  /// Returns the measurements for the true state `truth` of sample k. Call it once per sample, in
  /// order from k = 0.
  Sensed at(std::size_t k, const State<double>& truth);

 private:
  void receive_fixes(std::size_t k, const State<double>& truth, Sensed& sensed);
  /// A sensor with the state of its noise.
  struct Sensor {
    Sensor(const Channel& channel, double sample_time_s, const Random& random,
           const std::vector<double>* normals);
    double read(std::size_t k, double truth);
    /// Returns the next value n_k of the noise, divided by its standard deviation. The w_k are
    /// independent standard normal numbers, tau is the correlation time, T_s the sample time:
    ///   n_0 = w_0,   n_k = rho n_{k-1} + sqrt(1 - rho^2) w_k,   rho = exp(-T_s/tau)
    double next_noise(std::size_t k);

    Channel channel;
    std::size_t latency;  ///< whole samples of the latency
    double part;          ///< rest of the latency, as a fraction of a sample, [0, 1)
    double correlation;   ///< rho: correlation of the noise of successive samples
    double noise = 0.0;   ///< n_{k-1}: last noise, divided by its standard deviation
    Random random;
    const std::vector<double>* normals;  ///< one w_k per sample; null: they are drawn from `random`
  };
  /// Returns the true value of a quantity at the time of sample k minus the latency of the sensor,
  /// interpolated linearly between samples. Before the first sample, returns the value of the first
  /// sample.
  double truth_at(std::size_t k, const Sensor& sensor, double Measurement<double>::*quantity) const;

  std::optional<Sensors> sensors_;
  double sample_time_s_;
  Sensor heading_, yaw_rate_, speed_;
  Random gps_;
  /// True motion at the latest samples, as many as the latencies of the sensors need.
  std::vector<Measurement<double>> motion_;
  /// number of past positions to keep, for the latency of the GPS
  std::size_t kept_;
  /// true position at sample k, stored at the index k modulo kept_
  std::vector<Position<double>> true_m_;
  Position<double> fix_m_{};  ///< the last fix
  double fix_taken_s_ = 0.0;
  std::size_t next_fix_ = 0;  ///< number of the next fix that will arrive
};

/// Standard deviation of a fix on each axis, m, caused by noise and quantisation.
double fix_noise_m(const Gps& gps);

/// Computes the position for the guidance. If the scenario has a GPS, this is the position estimate
/// of the firmware, or the last fix if the scenario disables the estimate. Else it is the true
/// position.
class Positioning {
 public:
  Positioning(const Scenario& scenario, double sample_time_s);
  /// Returns the position at the time `t_s`. Call it once per sample, in order.
  Position<double> step(double t_s, const Sensed& sensed);
  /// Number of resets of the estimate so far.
  int resets() const { return estimate_ ? estimate_->resets : 0; }

 private:
  std::optional<PositionEstimate<double>> estimate_;
};

}  // namespace awmr
