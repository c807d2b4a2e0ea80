#include "injections.h"

#include <algorithm>

#include "awmr/control/faults.h"

namespace awmr::pil {
namespace {

using cli::Injection;

// Fault bits that the autopilot may raise after the checks of the sketches have rejected a heading
// (or speed) sensor. The rejection has two effects, whose faults may come in either order. The
// autopilot gets no new readings, so the last reading becomes too old. The sketches disarm the
// vehicle, so the last command becomes too old.
constexpr std::uint8_t kHeading = kFaultHeadingStale | kFaultCommandTimeout;
constexpr std::uint8_t kSpeed = kFaultSpeedStale | kFaultCommandTimeout;

constexpr InjectionEffect kEffects[] = {
    {Injection::kNone, Duration::kNever, kFaultNone},
    {Injection::kReset, Duration::kNever, kFaultNone},
    {Injection::kNaN, Duration::kTwentySteps, kFaultNotFinite},
    {Injection::kInfinite, Duration::kTwentySteps, kFaultNotFinite},
    {Injection::kRange, Duration::kTwentySteps, kFaultRange},
    {Injection::kMode, Duration::kTwentySteps, kFaultRange},
    {Injection::kHeadingStale, Duration::kTwentySteps, kFaultHeadingStale},
    {Injection::kSpeedStale, Duration::kTwentySteps, kFaultSpeedStale},
    {Injection::kCommandTimeout, Duration::kTwentySteps, kFaultCommandTimeout},
    {Injection::kStepLate, Duration::kOneStep, kFaultStepLate},
    {Injection::kParameters, Duration::kWholeRun, kFaultParameters},
    // Failures of the sensors. The last number of each row is the longest permitted time to the
    // safe command, s: the time of detection plus the autopilot's timeout. During a turn, a frozen
    // compass or gyroscope contradicts the other sensor (kHeadingOutOfStep). This is detected
    // before the check for frozen values has seen enough equal readings.
    {Injection::kCompassSilent, Duration::kFromTheMiddle, kHeading, kCompassSilent, kSensorGood,
     1.5},
    {Injection::kCompassFrozen, Duration::kFromTheMiddle, kHeading, kCompassFrozen,
     kHeadingOutOfStep, 1.5},
    {Injection::kCompassJump, Duration::kFromTheMiddle, kHeading, kHeadingOutOfStep, kSensorGood,
     1.5},
    // A stuck heading is detected only in the next turn, so the permitted time is long.
    {Injection::kCompassStuck, Duration::kFromTheMiddle, kHeading, kHeadingOutOfStep, kSensorGood,
     40.0},
    {Injection::kGyroSilent, Duration::kFromTheMiddle, kHeading, kGyroSilent, kSensorGood, 1.5},
    {Injection::kGyroFrozen, Duration::kFromTheMiddle, kHeading, kGyroFrozen, kHeadingOutOfStep,
     1.5},
    {Injection::kGyroRange, Duration::kFromTheMiddle, kHeading, kGyroRange, kSensorGood, 1.5},
    {Injection::kGyroDrift, Duration::kFromTheMiddle, kHeading, kHeadingOutOfStep, kSensorGood,
     6.0},
    {Injection::kGpsSilent, Duration::kFromTheMiddle, kSpeed, kGpsSilent, kSensorGood, 1.5},
    {Injection::kGpsNoFix, Duration::kFromTheMiddle, kSpeed, kGpsNoFix, kSensorGood, 1.5},
    {Injection::kGpsEmpty, Duration::kFromTheMiddle, kSpeed, kGpsNoFix, kSensorGood, 1.5},
    {Injection::kGpsDamaged, Duration::kFromTheMiddle, kSpeed, kGpsNoFix, kSensorGood, 1.5},
    {Injection::kGpsRepeated, Duration::kFromTheMiddle, kSpeed, kGpsRepeated, kSensorGood, 1.5},
    {Injection::kGpsLate, Duration::kFromTheMiddle, kSpeed, kGpsSilent, kSensorGood, 1.5},
    {Injection::kGpsJump, Duration::kFromTheMiddle, kSpeed, kGpsJump, kSensorGood, 1.5},
    // Failures that are detected only after the vehicle has driven 2 to 6 m, which takes long at
    // low speed: speed stuck at 0, frozen position, reversed motors.
    {Injection::kGpsSpeedZero, Duration::kFromTheMiddle, kFaultCommandTimeout, kGpsInconsistent,
     kSensorGood, 40.0},
    {Injection::kGpsPositionFrozen, Duration::kFromTheMiddle, kFaultCommandTimeout,
     kGpsInconsistent, kSensorGood, 5.0},
    {Injection::kMotorsReversed, Duration::kFromTheMiddle, kFaultCommandTimeout, kWrongWay,
     kSensorGood, 40.0},
    // Exchanged motors (left and right) are detected in the next turn.
    {Injection::kSidesSwapped, Duration::kFromTheMiddle, kHeading, kWrongTurn, kSensorGood, 40.0},
    // A reversed gyroscope is detected by one of two checks: the filtered heading departs from the
    // compass, or the vehicle seems to turn against the commanded yaw moment.
    {Injection::kGyroReversed, Duration::kFromTheMiddle, kHeading, kHeadingOutOfStep, kWrongTurn,
     40.0},
    {Injection::kSteeringStuck, Duration::kFromTheMiddle, kFaultCommandTimeout, kOffCourse,
     kSensorGood, 60.0},
    {Injection::kServoReversed, Duration::kFromTheMiddle, kHeading, kWrongTurn, kOffCourse, 60.0},
    {Injection::kCompassTurning, Duration::kFromTheMiddle, kFaultCommandTimeout, kOffHeading,
     kWrongWay, 40.0},
    // Failures of the operator's line. The permitted time is the timeout of the commands plus the
    // interval between two commands. STOP must take effect in the next step, so its time is short.
    {Injection::kCommandSilence, Duration::kFromTheMiddle, kFaultCommandTimeout, kSensorGood,
     kSensorGood, 1.4},
    {Injection::kCommandNoise, Duration::kFromTheMiddle, kFaultCommandTimeout, kSensorGood,
     kSensorGood, 1.4},
    {Injection::kCommandUnknown, Duration::kFromTheMiddle, kFaultCommandTimeout, kSensorGood,
     kSensorGood, 1.4},
    {Injection::kCommandRepeatedFrame, Duration::kFromTheMiddle, kFaultCommandTimeout, kSensorGood,
     kSensorGood, 1.7},
    {Injection::kStop, Duration::kFromTheMiddle, kFaultCommandTimeout, kSensorGood, kSensorGood,
     0.05},
    {Injection::kStopInNoise, Duration::kFromTheMiddle, kFaultCommandTimeout, kSensorGood,
     kSensorGood, 0.05}};
static_assert(std::size(kEffects) == cli::kInjectionNames.size());

}  // namespace

const InjectionEffect& effect_of(Injection injection) {
  return *std::find_if(std::begin(kEffects), std::end(kEffects),
                       [&](const InjectionEffect& one) { return one.injection == injection; });
}

bool disarms(Injection injection) { return effect_of(injection).within_s > 0.0; }

bool is_command_failure(Injection injection) {
  return disarms(injection) && effect_of(injection).cause == kSensorGood;
}

bool is_expected_cause(Injection injection, SensorFault cause) {
  const InjectionEffect& effect = effect_of(injection);
  return cause == effect.cause || (cause != kSensorGood && cause == effect.other_cause);
}

Window injection_window(Injection injection, std::size_t middle, std::size_t samples) {
  switch (effect_of(injection).duration) {
    case Duration::kNever:
      break;
    case Duration::kWholeRun:
      return {0, samples + 1};
    case Duration::kOneStep:
      return {middle, middle + 1};
    case Duration::kTwentySteps:
      return {middle, middle + 20};
    case Duration::kFromTheMiddle:
      return {middle, samples + 1};
  }
  return {0, 0};
}

}  // namespace awmr::pil
