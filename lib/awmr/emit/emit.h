/// Firmware output: makes awmr_params.h, a header with the identified model and the tuned gains,
/// and an Arduino library that contains it.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/control/parameters_block.h"
#include "awmr/control/position_filter.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/core/units.h"
#include "awmr/model/certificate.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"

namespace awmr {

/// Input files that the emitted headers name as their origin. The name of the model file is in
/// Model::file.
struct EmitInputs {
  std::string model_sha256;               ///< SHA-256 of the model file, lower-case hexadecimal
  std::string gains_sha256;               ///< SHA-256 of the gains file, lower-case hexadecimal
  std::string gains_file = "gains.json";  ///< name without directories
  /// Robustness certificate of the gains; absent if they have none, are of another model,
  /// or were changed.
  std::optional<CertifiedGains> certificate = {};
  /// True if the gains were tuned with another model, so that their stability with this model was
  /// not checked. The header then states this in place of the certificate.
  bool has_gains_of_another_model = false;
  /// True if the gains were changed after tuning. The header then states that their stability was
  /// not checked.
  bool has_changed_gains = false;
};

/// Returns the value of AWMR_PARAMS_SHA256, which identifies both input files: the SHA-256 of a
/// text of 128 characters, the hexadecimal SHA-256 of the model file followed by the hexadecimal
/// SHA-256 of the gains file.
std::string params_sha256(const EmitInputs& inputs);

/// Text of awmr_params.h in ASCII, valid in C89, C++98 and later. Each value is rounded to float32
/// once and written with nine significant digits, which read back to the same float. Errors
/// (input): the model lacks a parameter; values do not fit a float32 or are out of their range (all
/// are reported); the smallest wheel force is not below the largest; the steering stop is not below
/// 90 deg; the observer's bandwidth times the sample time is not below 1. Errors (refused): in
/// float32, T2 = epsilon/(2 mu) is not below T1 = 1/lambda.
Result<std::string> params_header(const Model& model, const ModeGains& gains,
                                  const EmitInputs& inputs);

/// Method by which the firmware computes the resistances g1 (surge) and g3 (yaw).
enum class ResistanceForm {
  kTable,  ///< interpolates a table in flash: much faster than kPowf, needs more flash
  kPowf    ///< computes the power law with the C library's powf; supports no other law
};
inline constexpr NameTable<ResistanceForm, 2> kResistanceFormNames{
    {{"table", ResistanceForm::kTable}, {"powf", ResistanceForm::kPowf}}};

/// Optional features of the firmware. Heading hold and waypoints are always included.
enum class FirmwarePart {
  kLine,       ///< follow a line or polyline
  kPath,       ///< follow a timed path
  kSlowDown,   ///< slow down before the last waypoint or the end of the line
  kAvoidance,  ///< avoid obstacles
  kShaping,    ///< limit rate and acceleration of the heading reference
  kObserver    ///< estimate constant disturbances (slope, unequal motors) and compensate them
};
inline constexpr NameTable<FirmwarePart, 6> kFirmwarePartNames{
    {{"line", FirmwarePart::kLine},
     {"path", FirmwarePart::kPath},
     {"slow_down", FirmwarePart::kSlowDown},
     {"avoidance", FirmwarePart::kAvoidance},
     {"shaping", FirmwarePart::kShaping},
     {"observer", FirmwarePart::kObserver}}};

/// The optional features of the firmware: `parts`, and kObserver if the gains have an observer.
std::set<FirmwarePart> parts_with(std::set<FirmwarePart> parts, const ModeGains& gains);

/// Largest number of clock cycles that a control step with these parts takes on the ATmega2560: the
/// slowest guidance, plus the parts computed in addition. The numbers are the largest
/// `cycles_bound` of `awmr pil` over configs/ (apps/awmr-pil/README.md), rounded up. They were
/// measured in a search for slow steps: a slower step is possible.
std::uint32_t longest_step_cycles(const std::set<FirmwarePart>& parts, ResistanceForm resistance);

/// Clock frequency of the ATmega2560 on the supported boards, Hz.
inline constexpr double kChipClock_Hz = 16e6;

/// Default of EmitOptions::table_error, chosen far below the usual uncertainty of an identified
/// law. A smaller bound needs larger tables.
inline constexpr double kTableError = 5e-4;

/// Options of the firmware.
struct EmitOptions {
  /// kPowf saves flash but lengthens the control step, and supports only the power law.
  ResistanceForm resistance = ResistanceForm::kTable;
  /// Bound on the relative error of a resistance table, > 0: relative to the resistance or, where
  /// this is small, to a tenth of the largest force (surge: 4 F'max) or moment (yaw: 4 d F'max). A
  /// larger bound gives a smaller table. Absent: kTableError or, if no table meets this bound, the
  /// smallest error possible.
  std::optional<double> table_error = {};
  /// Optional features to compile in. Each needs flash, RAM and, while in use, time in every step.
  std::set<FirmwarePart> parts = {};
  /// Guidance law of the part kLine: index in LineLaws (control/guidance/line_laws.h).
  std::size_t line_law = 0;
  /// How the combined mode divides the yaw moment when steering or wheel forces saturate.
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// Maximum age of heading and yaw rate, ms, > 0; older values are a fault. A slow compass needs a
  /// larger limit.
  std::uint32_t heading_timeout_ms = 100;
  /// Maximum age of speed and position, ms, > 0. The default permits two missing fixes of a 5 Hz
  /// GPS.
  std::uint32_t speed_timeout_ms = 600;
  /// Maximum age of the last command, ms, > 0; after it, the motors stop. For an unreliable radio
  /// link, use a larger limit; but the larger the limit, the longer the vehicle drives on without
  /// commands.
  std::uint32_t command_timeout_ms = 1000;
  /// Maximum time between two control steps, ms; 0: three sample times, rounded up.
  std::uint32_t step_timeout_ms = 0;
};

/// A table of the surge resistance g1 or the yaw resistance g3 for the chip, and its errors. Speeds
/// are in m/s for g1, in rad/s for g3.
struct EmittedTable {
  std::vector<ResistanceLine> lines;  ///< the lines, as in ResistanceTable::lines
  std::uint16_t first = 0;            ///< number of the first cell (ResistanceTable::first)
  std::uint8_t mantissa_bits = 0;     ///< leading mantissa bits that number the cells, 0 ... 7
  double lowest_speed = 0.0;          ///< speed at which the first cell begins; below it, the table
                                      ///< is a line through the origin
  double top_speed = 0.0;             ///< speed at which the last cell ends
  double split = 0.0;        ///< tenth of the largest force (g1) or moment (g3), in the unit of g
  double worst_error = 0.0;  ///< largest error where g is below `split`, in the unit of g
  double worst_relative_error = 0.0;  ///< largest error relative to g, where g is above `split`

  /// Returns the largest relative error: relative to g, or to `split` where g is below `split`.
  double largest_relative_error() const;
  /// Returns the table in the type that the chip reads. It points to `lines` of this object.
  ResistanceTable view() const;
};

/// Noise (standard deviation of a fix per axis, m) and latency (s) of the GPS, if vehicle.json does
/// not give them.
inline constexpr double kUsualFixNoise_m = 1.5;
inline constexpr double kUsualFixLatency_s = 0.2;

/// Upper bound of AWMR_ON_COURSE_RAD, rad, the heading error up to which the sketches count a
/// vehicle as on course. With a larger bound, a vehicle off its course drives further before it is
/// stopped.
inline constexpr double kMaxOnCourse_rad = radians(45.0);

/// Parameters of the firmware, in the types that the chip uses.
struct AutopilotParameters {
  ParameterBlock block{};
  /// Coulomb friction, dead zone and back-EMF that the firmware compensates; absent if the model
  /// has none of them.
  std::optional<RestBlock> rest;
  /// The observer that the gains were tuned with. Absent: no observer, unless the sketch enables
  /// one.
  std::optional<ObserverBlock> observer;
  /// Gains of each mode; absent if all modes have the same.
  std::optional<ModeGainsBlock> mode_gains;
  float steering_max_tan_half = 0.0F;                  ///< tan(d_max/2), d_max: steering stop
  EmittedTable surge;                                  ///< table of g1; empty for kPowf
  EmittedTable yaw;                                    ///< table of g3; empty for kPowf
  ResistanceForm resistance = ResistanceForm::kTable;  ///< as in EmitOptions
  double table_error = 0.0;               ///< bound on the relative error of both tables: that of
                                          ///< EmitOptions, or the error of a table that exceeds it
  float sample_time_s = 0.0F;             ///< AWMR_SAMPLE_TIME_S, s
  float route_speed_mps = 0.0F;           ///< AWMR_ROUTE_SPEED_MPS, m/s
  float command_speed_max_mps = 0.0F;     ///< AWMR_COMMAND_SPEED_MAX_MPS, m/s
  double steady_error_rad = 0.0;          ///< heading error, rad, that remains if the forces of
                                          ///< left and right motors differ by 16 %
  float on_course_rad = 0.0F;             ///< AWMR_ON_COURSE_RAD, rad
  float off_course_mrad = 0.0F;           ///< AWMR_OFF_COURSE_MRAD, m rad
  PositionFilter<float> position{};       ///< filter of the GPS fixes
  std::uint32_t position_latency_ms = 0;  ///< latency of the GPS, ms
  std::set<FirmwarePart> parts;           ///< result of parts_with() for the gains
  std::size_t line_law = 0;               ///< as in EmitOptions
  CombinedSplit split = CombinedSplit::kRedistribute;  ///< as in EmitOptions
  std::uint32_t crc = 0;  ///< check sum over block, tables, rest, observer and mode_gains
};

/// True if both resistances are power laws, which the firmware can also compute by powf.
bool is_power_law(const Plant<double>& plant);

/// Computes the numbers of the firmware from the model and the gains. Errors: those of
/// params_header(); (input) small-angle allocation, front-wheel drive, or kPowf for another
/// resistance than the power law; (refused) no table meets the given options.table_error.
Result<AutopilotParameters> autopilot_parameters(const Model& model, const ModeGains& gains,
                                                 const EmitInputs& inputs,
                                                 const EmitOptions& options);

/// Text of awmr_autopilot_params.h: the optional features, the tables with their errors, the limits
/// of the safety checks, values of the sketches, and the checksum `crc`.
std::string autopilot_header(const AutopilotParameters& parameters);

/// A file of the emitted library.
struct EmittedFile {
  std::string path;  ///< path from the output directory, with '/'
  std::string bytes;
};

/// Creates an Arduino library: awmr_params.h, library.properties, src/ with the C interface and the
/// unchanged control sources, and examples/. PlatformIO and plain avr-gcc (with -I src) accept it,
/// too. The same inputs give the same bytes. Errors: those of autopilot_parameters().
Result<std::vector<EmittedFile>> firmware_library(const Model& model, const ModeGains& gains,
                                                  const EmitInputs& inputs,
                                                  const EmitOptions& options);

}  // namespace awmr
