// Table of the injections of `awmr pil --inject`: effect, duration and expected detection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "awmr/control/sensor_fault.h"
#include "pil_options.h"

namespace awmr::pil {

/// When an injection acts.
enum class Duration {
  kNever,         ///< the controller's inputs are not changed
  kWholeRun,      ///< from the start to the end
  kOneStep,       ///< one step in the middle of the run
  kTwentySteps,   ///< twenty steps from the middle of the run on
  kFromTheMiddle  ///< from the middle to the end
};

/// One row of the table.
struct InjectionEffect {
  cli::Injection injection;
  Duration duration;
  std::uint8_t fault;  ///< expected fault bits of the autopilot; at least one must be raised
  /// Sensor check that must detect the failure; kSensorGood: not a sensor failure.
  SensorFault cause = kSensorGood;
  SensorFault other_cause = kSensorGood;  ///< another check that may detect the failure first
  /// Longest time to the safe command, s, for failures that disarm the vehicle; 0 for the others.
  double within_s = 0.0;
};

const InjectionEffect& effect_of(cli::Injection injection);

/// True for failures of a sensor, the motors, the servo or the operator's line, which the checks of
/// the sketches detect and answer by disarming the vehicle.
bool disarms(cli::Injection injection);
/// True for failures of the operator's line.
bool is_command_failure(cli::Injection injection);

/// True if `cause` is a check that may detect this injection first. `cause` is kSensorGood for
/// failures of the operator's line.
bool is_expected_cause(cli::Injection injection, SensorFault cause);

/// Indices of the samples at which an injection acts: [first, last); empty if it never acts.
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
};
/// `middle`: index of the sample in the middle of the run; `samples`: number of samples of the run.
Window injection_window(cli::Injection injection, std::size_t middle, std::size_t samples);

}  // namespace awmr::pil
