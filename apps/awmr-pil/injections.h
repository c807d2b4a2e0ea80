// Table of the failures of `awmr pil --inject`: when each acts, and which fault must detect it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "awmr/emit/board/sensor_fault.h"
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
  /// Check of the sketches that must detect the failure. kSensorGood: no sensor check detects it.
  SensorFault cause = kSensorGood;
  SensorFault other_cause = kSensorGood;  ///< another check that may detect the failure first
  /// Longest permitted time to the safe command, s. 0 for failures that do not disarm the vehicle.
  double within_s = 0.0;
};

const InjectionEffect& effect_of(cli::Injection injection);

/// True if the checks of the sketches must detect the failure and disarm the vehicle: failures of a
/// sensor, the motors, the servo or the operator's line.
bool disarms(cli::Injection injection);
/// True for failures of the operator's line.
bool is_command_failure(cli::Injection injection);

/// True if the sensor check `cause` may be the first one to detect this injection. Failures of the
/// operator's line have the cause kSensorGood, because no sensor fails.
bool is_expected_cause(cli::Injection injection, SensorFault cause);

/// Steps in which an injection acts: from `first` to before `last`; equal if it never acts.
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
};
/// Returns the window of an injection. `middle`: number of the step in the middle of the run;
/// `samples`: number of steps of the run.
Window injection_window(cli::Injection injection, std::size_t middle, std::size_t samples);

}  // namespace awmr::pil
