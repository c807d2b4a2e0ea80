/// Options of `awmr pil`, shared with the program awmr-pil, which executes that command.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/name_table.h"
#include "awmr/emit/emit.h"

namespace CLI {
class App;
}  // namespace CLI

namespace awmr::cli {

enum class PilLink { kMemory, kUart };
inline constexpr NameTable<PilLink, 2> kPilLinkNames{
    {{"memory", PilLink::kMemory}, {"uart", PilLink::kUart}}};

/// Optimisation goal of the firmware build.
enum class Optimize { kSpeed, kSize };
inline constexpr NameTable<Optimize, 2> kOptimizeNames{
    {{"speed", Optimize::kSpeed}, {"size", Optimize::kSize}}};

/// Faults that `--inject` can cause, one in each run: in the inputs or parameters of the
/// controller, the sensors, the motors, the servo, or the line on which the operator sends
/// commands.
enum class Injection {
  kNone,
  kNaN,             ///< measured yaw rate is NaN
  kInfinite,        ///< measured speed is infinite
  kRange,           ///< measured speed beyond any that the vehicle can reach
  kMode,            ///< yaw-control mode is none of the three
  kHeadingStale,    ///< the time of the last heading is 10 s old
  kSpeedStale,      ///< the time of the last speed is 10 s old
  kCommandTimeout,  ///< the time of the last command is 10 s old
  kStepLate,        ///< a pause of 10 s before a step
  kParameters,      ///< a bit of the parameters in flash is flipped before the start
  kReset,           ///< the chip is reset, as after a drop of its supply, and starts again
  // Sensor failures. The checks of the emitted sketches detect them (emit/board/heading_check.h,
  // gps_check.h).
  kCompassSilent,      ///< no new field measurement
  kCompassFrozen,      ///< raw values repeat
  kCompassJump,        ///< offset of 57 deg
  kCompassStuck,       ///< heading stays at its value, with noise
  kGyroSilent,         ///< no reading arrives
  kGyroFrozen,         ///< raw value repeats
  kGyroRange,          ///< the sensor switches to another measuring range
  kGyroDrift,          ///< offset of 8.6 deg/s
  kGpsSilent,          ///< no sentence arrives
  kGpsNoFix,           ///< sentences without a fix
  kGpsEmpty,           ///< sentences with empty fields
  kGpsDamaged,         ///< sentences with a wrong checksum
  kGpsRepeated,        ///< the last sentence again and again
  kGpsLate,            ///< sentences with 2 s latency
  kGpsJump,            ///< the position is off by 20 m
  kGpsSpeedZero,       ///< a speed that is stuck at 0
  kGpsPositionFrozen,  ///< the position does not change, although the speed is above 0
  kMotorsReversed,     ///< the vehicle drives in the wrong direction, but turns as commanded
  kSidesSwapped,       ///< left and right motors exchanged
  kGyroReversed,       ///< yaw rate of the wrong sign
  kSteeringStuck,      ///< the servo is stuck straight
  kServoReversed,      ///< the servo turns the wrong way
  kCompassTurning,     ///< the measured heading drifts by 2.5 deg/s
  // Failures of the operator's line, whose characters are read as the sketches do
  // (emit/board/command_line.h).
  kCommandSilence,        ///< no command arrives
  kCommandNoise,          ///< characters without a line end
  kCommandUnknown,        ///< unknown commands
  kCommandRepeatedFrame,  ///< one command frame again and again
  kStop,                  ///< the operator sends STOP
  kStopInNoise            ///< STOP within other characters, without a line end
};
inline constexpr NameTable<Injection, 40> kInjectionNames{
    {{"none", Injection::kNone},
     {"nan", Injection::kNaN},
     {"infinite", Injection::kInfinite},
     {"range", Injection::kRange},
     {"mode", Injection::kMode},
     {"heading-stale", Injection::kHeadingStale},
     {"speed-stale", Injection::kSpeedStale},
     {"command-timeout", Injection::kCommandTimeout},
     {"step-late", Injection::kStepLate},
     {"parameters", Injection::kParameters},
     {"reset", Injection::kReset},
     {"compass-silent", Injection::kCompassSilent},
     {"compass-frozen", Injection::kCompassFrozen},
     {"compass-jump", Injection::kCompassJump},
     {"compass-stuck", Injection::kCompassStuck},
     {"gyro-silent", Injection::kGyroSilent},
     {"gyro-frozen", Injection::kGyroFrozen},
     {"gyro-range", Injection::kGyroRange},
     {"gyro-drift", Injection::kGyroDrift},
     {"gps-silent", Injection::kGpsSilent},
     {"gps-no-fix", Injection::kGpsNoFix},
     {"gps-empty", Injection::kGpsEmpty},
     {"gps-damaged", Injection::kGpsDamaged},
     {"gps-repeated", Injection::kGpsRepeated},
     {"gps-late", Injection::kGpsLate},
     {"gps-jump", Injection::kGpsJump},
     {"gps-speed-zero", Injection::kGpsSpeedZero},
     {"gps-position-frozen", Injection::kGpsPositionFrozen},
     {"motors-reversed", Injection::kMotorsReversed},
     {"sides-swapped", Injection::kSidesSwapped},
     {"gyro-reversed", Injection::kGyroReversed},
     {"steering-stuck", Injection::kSteeringStuck},
     {"servo-reversed", Injection::kServoReversed},
     {"compass-turning", Injection::kCompassTurning},
     {"command-silence", Injection::kCommandSilence},
     {"command-noise", Injection::kCommandNoise},
     {"command-unknown", Injection::kCommandUnknown},
     {"command-repeated-frame", Injection::kCommandRepeatedFrame},
     {"stop", Injection::kStop},
     {"stop-in-noise", Injection::kStopInNoise}}};

/// The help of each option describes it (pil_options.cpp); `output` is -o.
struct PilOptions {
  std::filesystem::path model;
  std::filesystem::path gains;
  std::filesystem::path scenario;
  YawMode mode = YawMode::kCombined;
  PilLink link = PilLink::kMemory;
  std::optional<std::filesystem::path> port;
  unsigned baud = 500000;
  EmitOptions emit;
  std::optional<Optimize> optimize;
  std::optional<unsigned> cycles_max;
  unsigned flash_max = 20480;            ///< bytes
  unsigned ram_max = 1024;               ///< bytes
  std::optional<double> difference_max;  ///< in the SI unit of each signal
  /// With avoided obstacles or simulated sensors, the default is larger, because one of the runs
  /// may change its path one sensor sample before the other.
  std::optional<double> heading_max_deg;
  Injection injection = Injection::kNone;
  unsigned hostile_steps = 6000;
  double line_noise = 0.0;
  std::optional<std::filesystem::path> build_directory;
  std::filesystem::path output;
};

/// Adds all options except `-o`.
void add_pil_options(CLI::App& command, PilOptions& options);

}  // namespace awmr::cli
