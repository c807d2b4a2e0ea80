// Injects sensor failures. Derives raw readings from the simulated motion, and applies the checks
// of the sketches to them (emit/board/heading_check.h, gps_check.h). As on the board, a sensor that
// a check rejects keeps its old time stamp, so the autopilot soon finds its reading too old.
#pragma once

#include <deque>
#include <optional>
#include <random>

#include "awmr/control/autopilot.h"
#include "awmr/emit/board/gps_check.h"
#include "awmr/emit/board/heading_check.h"
#include "pil_options.h"

namespace awmr::pil {

/// Commands of the autopilot in the previous step.
struct Commanded {
  float moment_m;     ///< commanded yaw moment divided by F_max, m; 0: the motors are off
  float psi_ref_rad;  ///< commanded heading
};

/// Compass, gyroscope and GPS of one run.
class CheckedSensors {
 public:
  CheckedSensors(cli::Injection injection, double sample_time_s, const GpsLimits& limits);

  /// Executes control step number k. Sets the times of the last accepted readings in in.times.
  /// Returns the check that rejects a sensor; kSensorGood if none does. `fails`: the injected
  /// failure is present; it may also change in.measured.
  SensorFault step(std::size_t k, bool fails, const Commanded& before, AutopilotInput& in);

 private:
  cli::Injection injection_;
  double sample_time_s_;
  HeadingCheck heading_;
  GpsCheck<> gps_;
  std::mt19937 random_{1};
  std::int16_t word_ = 0;
  std::int16_t field_[3] = {0, 0, 0};
  double heading_rad_ = 0.0;  ///< output of the complementary filter
  bool has_heading_ = false;
  /// Heading that a stuck compass keeps; absent if the compass is not stuck.
  std::optional<double> stuck_rad_;
  /// Heading error of a drifting compass so far.
  double turned_rad_ = 0.0;
  std::optional<GpsFix> fix_;
  Position<float> fix_m_{};
  bool has_position_ = false;
  /// A delayed fix of the receiver.
  struct DelayedFix {
    std::uint32_t sent_ms;
    GpsFix fix;
    Position<float> position_m;
  };
  std::deque<DelayedFix> delayed_;
  std::uint32_t heading_ms_ = 0, speed_ms_ = 0;
  float psi_ref_rad_ = 0.0F;  ///< commanded heading

  void sense_heading(bool fails, const AutopilotInput& in);
  void sense_position(std::size_t k, bool fails, const AutopilotInput& in);
  void take_fix(const GpsFix& fix, const Position<float>& position_m, const AutopilotInput& in);
};

}  // namespace awmr::pil
