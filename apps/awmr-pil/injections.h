// What each injection of `awmr pil --inject` breaks, for how long, and what has to find it: one table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "awmr/control/sensor_fault.h"
#include "pil_options.h"

namespace awmr::pil {

/// When an injection acts.
enum class Duration {
  kNever,         ///< the controller's inputs are left alone
  kWholeRun,      ///< from the start
  kOneStep,       ///< at the middle
  kTwentySteps,   ///< from the middle on
  kFromTheMiddle  ///< to the end
};

/// One row of the table.
struct InjectionEffect {
  cli::Injection injection;
  Duration duration;
  std::uint8_t fault;  ///< bits of the autopilot's fault, one of which has to be raised
  /// The sensor check that has to find it; kSensorGood: not a failure of a sensor.
  SensorFault cause = kSensorGood;
  SensorFault other_cause = kSensorGood;  ///< or this one, where it is faster
  /// Safe command, for failures that the sketches' checks find and that disarm; 0: none of these.
  double within_s = 0.0;
};

const InjectionEffect& effect_of(cli::Injection injection);

/// True for failures of a sensor, of the motors or of the operator's line, which the checks of the
/// sketches find: the vehicle is disarmed.
bool disarms(cli::Injection injection);
/// True for those of the operator's line.
bool is_command_failure(cli::Injection injection);

/// True if `cause` is a sensor fault that this injection may raise first; kSensorGood for failures of
/// the operator's line.
bool is_expected_cause(cli::Injection injection, SensorFault cause);

/// Samples at which an injection acts: [first, last).
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
};
Window injection_window(cli::Injection injection, std::size_t middle, std::size_t samples);

}  // namespace awmr::pil
