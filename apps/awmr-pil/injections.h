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
  kWholeRun,      ///< from the start
  kOneStep,       ///< in the middle of the run
  kTwentySteps,   ///< from the middle of the run on
  kFromTheMiddle  ///< from the middle to the end
};

/// One row of the table.
struct InjectionEffect {
  cli::Injection injection;
  Duration duration;
  std::uint8_t fault;  ///< expected fault bits of the autopilot; one of them must be raised
  /// Sensor check that must detect it; kSensorGood: not a sensor failure.
  SensorFault cause = kSensorGood;
  SensorFault other_cause = kSensorGood;  ///< another check, which may detect it first
  /// Longest time to the safe command, s, for failures that disarm the vehicle; else 0.
  double within_s = 0.0;
};

const InjectionEffect& effect_of(cli::Injection injection);

/// True for failures of a sensor, of the motors or of the operator's line. The checks of the
/// sketches detect them and disarm the vehicle.
bool disarms(cli::Injection injection);
/// True for failures of the operator's line.
bool is_command_failure(cli::Injection injection);

/// True if this injection may raise `cause` first; kSensorGood for failures of the operator's line.
bool is_expected_cause(cli::Injection injection, SensorFault cause);

/// Samples at which an injection acts: [first, last).
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
};
Window injection_window(cli::Injection injection, std::size_t middle, std::size_t samples);

}  // namespace awmr::pil
