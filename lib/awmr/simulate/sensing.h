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

/// Measurements of one sample.
struct Sensed {
  Measurement<double> motion;
  Position<double> position_m;  ///< without a GPS the true one, else that of the last fix
  double fix_taken_s = 0.0;     ///< when the last fix was taken
  bool is_fix_new = false;      ///< it arrived since the sample before
};

/// The sensors of one run, with their noise, latency and drop-outs.
class Sensing {
 public:
  /// `noise`: null, or what draw_sensor_noise() gives for this seed; it outlives the sensors.
  Sensing(const std::optional<Sensors>& sensors, double sample_time_s, const RunSeed& seed,
          const DrawnNoise* noise = nullptr);
  /// The k-th sample; call it once per sample, in order from 0.
  Sensed at(std::size_t k, const State<double>& truth);

 private:
  void receive_fixes(std::size_t k, const State<double>& truth, Sensed& sensed);
  /// A sensor's channel with its noise.
  struct Sensor {
    Sensor(const Channel& channel, double sample_time_s, const Random& random,
           const std::vector<double>* normals);
    double read(std::size_t k, double truth);
    /// The next of the noise's standard normals:
    ///   n_0 = w_0,   n_k = rho n_{k-1} + sqrt(1 - rho^2) w_k,   rho = exp(-T_s/tau)
    double next_noise(std::size_t k);
    /// The sample whose truth is read at the k-th: before the first one, the first.
    std::size_t sample_read_at(std::size_t k) const { return k > latency ? k - latency : 0; }

    Channel channel;
    std::size_t latency;  ///< samples
    double correlation;   ///< rho
    double noise = 0.0;   ///< n_{k-1}
    Random random;
    const std::vector<double>* normals;  ///< null: drawn from `random`
  };
  std::optional<Sensors> sensors_;
  double sample_time_s_;
  Sensor heading_, yaw_rate_, speed_;
  Random gps_;
  std::vector<Measurement<double>> motion_;  ///< true, of the latest samples that are still read
  std::vector<Position<double>> true_m_;     ///< by sample
  Position<double> fix_m_{};                 ///< the last one
  double fix_taken_s_ = 0.0;
  std::size_t next_fix_ = 0;
};

}  // namespace awmr
