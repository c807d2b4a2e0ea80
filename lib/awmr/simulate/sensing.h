/// Sensor models: sampling, delay, bias, noise and quantisation of the measurements.
/// Private to this folder.
#pragma once

#include <optional>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/control/guidance/waypoints.h"
#include "awmr/model/state.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/disturbance.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// Measurements of one sample, with all sensor errors.
struct Sensed {
  Measurement<double> motion;
  Position<double> position_m;  ///< the last fix that has arrived; without GPS, the true position
  double fix_taken_s = 0.0;     ///< time at which this fix was taken; before the first fix, < 0
  bool is_fix_new = false;      ///< this fix arrived after the previous sample
};

/// The sensors of one run, with their noise and latency.
class Sensing {
 public:
  /// `noise`: null, or the result of draw_sensor_noise() for this seed, which must outlive the
  /// sensors.
  Sensing(const std::optional<Sensors>& sensors, double sample_time_s, const RunSeed& seed,
          const DrawnNoise* noise = nullptr);
  /// Measures the state `truth` of the k-th sample. Call it once per sample, in order from k = 0.
  Sensed at(std::size_t k, const State<double>& truth);

 private:
  void receive_fixes(std::size_t k, const State<double>& truth, Sensed& sensed);
  /// A sensor with the state of its noise.
  struct Sensor {
    Sensor(const Channel& channel, double sample_time_s, const Random& random,
           const std::vector<double>* normals);
    double read(std::size_t k, double truth);
    /// The next value n_k of the noise, over its standard deviation. With independent standard
    /// normals w_k and the correlation time tau:
    ///   n_0 = w_0,   n_k = rho n_{k-1} + sqrt(1 - rho^2) w_k,   rho = exp(-T_s/tau)
    double next_noise(std::size_t k);

    Channel channel;
    std::size_t latency;  ///< whole samples of the latency
    double part;          ///< remaining fraction of a sample of the latency, [0, 1)
    double correlation;   ///< rho: correlation of the noise of two successive samples
    double noise = 0.0;   ///< n_{k-1}: noise of the previous sample, over its standard deviation
    Random random;
    const std::vector<double>* normals;  ///< one w_k per sample; null: drawn from `random`
  };
  /// The true value of the quantity, earlier than the k-th sample by the latency of the sensor. It
  /// is interpolated linearly between samples. For times before the first sample, it is the value
  /// of the first sample.
  double truth_at(std::size_t k, const Sensor& sensor, double Measurement<double>::*quantity) const;

  std::optional<Sensors> sensors_;
  double sample_time_s_;
  Sensor heading_, yaw_rate_, speed_;
  Random gps_;
  std::vector<Measurement<double>> motion_;  ///< true motion of the latest samples, as many as the
                                             ///< sensors' latencies need
  std::size_t kept_;                         ///< number of samples within the latency of the GPS
  std::vector<Position<double>> true_m_;     ///< true position of sample k at k modulo kept_
  Position<double> fix_m_{};                 ///< the last fix
  double fix_taken_s_ = 0.0;
  std::size_t next_fix_ = 0;  ///< number of the next fix to arrive
};

}  // namespace awmr
