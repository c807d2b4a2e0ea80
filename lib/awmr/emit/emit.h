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
#include "awmr/model/gains.h"
#include "awmr/model/model.h"

namespace awmr {

/// Origin that the emitted files state, in addition to the name of the model's file.
struct EmitInputs {
  std::string model_sha256;               ///< SHA-256 of the model file, lower-case hexadecimal
  std::string gains_sha256;               ///< SHA-256 of the gains file, lower-case hexadecimal
  std::string gains_file = "gains.json";  ///< name without directories
  std::optional<CertifiedGains> certificate = {};  ///< robustness certificate of the gains, if any
};

/// Returns the value of AWMR_PARAMS_SHA256: the SHA-256 of a text of 128 characters, which is the
/// hexadecimal SHA-256 of the model followed by that of the gains.
std::string params_sha256(const EmitInputs& inputs);

/// Text of awmr_params.h in ASCII, valid in C89, C++98 and later. Each value is rounded to float32
/// once and written with nine significant digits, which read back to the same float. Errors
/// (input): the model lacks a parameter; values do not fit a float32 or are out of their range (all
/// are reported); the smallest wheel force is not below the largest; the steering stop is not below
/// 90 deg; the observer is too fast for the sample time. Errors (refused): T2 >= T1 in float32.
Result<std::string> params_header(const Model& model, const Gains<double>& gains,
                                  const EmitInputs& inputs);

/// Method by which the firmware computes the resistances g1 and g3.
enum class ResistanceForm {
  kTable,  ///< interpolates a table in flash: much faster, more flash
  kPowf    ///< computes the power law with the C library's powf
};
inline constexpr NameTable<ResistanceForm, 2> kResistanceFormNames{
    {{"table", ResistanceForm::kTable}, {"powf", ResistanceForm::kPowf}}};

/// Optional features of the firmware in addition to heading hold and waypoints.
enum class FirmwarePart {
  kLine,       ///< follow a line or polyline
  kPath,       ///< follow a timed path
  kSlowDown,   ///< slow down before the last point
  kAvoidance,  ///< avoid obstacles
  kShaping,    ///< limit rate and acceleration of the heading reference
  kObserver    ///< compensate the estimated disturbance
};
inline constexpr NameTable<FirmwarePart, 6> kFirmwarePartNames{
    {{"line", FirmwarePart::kLine},
     {"path", FirmwarePart::kPath},
     {"slow_down", FirmwarePart::kSlowDown},
     {"avoidance", FirmwarePart::kAvoidance},
     {"shaping", FirmwarePart::kShaping},
     {"observer", FirmwarePart::kObserver}}};

/// Default bound on the relative error of a table, far below the uncertainty of a model.
inline constexpr double kTableError = 5e-4;

/// Options of the firmware.
struct EmitOptions {
  /// Choose kPowf if flash is scarce and the control step has time to spare; for a power law only.
  ResistanceForm resistance = ResistanceForm::kTable;
  /// Bound on the relative error of a table, > 0. The error is relative to the resistance, or to a
  /// tenth of the largest force (surge: 4 F'max) or moment (yaw: 4 d F'max) where the resistance is
  /// smaller than that. A larger bound gives a smaller table. Absent: kTableError or, if no table
  /// meets it, the smallest error possible.
  std::optional<double> table_error = {};
  /// Optional features to compile in. Each needs flash, RAM and, while in use, time in every step.
  std::set<FirmwarePart> parts = {};
  /// Guidance law of the part kLine, as an index in LineLaws.
  std::size_t line_law = 0;
  /// How the combined mode divides the yaw moment when steering or wheel forces saturate.
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// Maximum age of heading and yaw rate, ms, > 0. A slow compass needs a larger value.
  std::uint32_t heading_timeout_ms = 100;
  /// Maximum age of speed and position, ms, > 0. The default permits two missing fixes of a 5 Hz
  /// GPS.
  std::uint32_t speed_timeout_ms = 600;
  /// Maximum age of the last command, ms, > 0; when it is exceeded, the motors stop. An unreliable
  /// radio link needs a larger value.
  std::uint32_t command_timeout_ms = 1000;
  /// Maximum time between two control steps, ms; 0: three sample times.
  std::uint32_t step_timeout_ms = 0;
};

/// A resistance table and its error relative to the law. Speeds are in m/s for g1, in rad/s for g3.
struct EmittedTable {
  std::vector<ResistanceLine> lines;  ///< ResistanceTable::lines
  std::uint16_t first = 0;            ///< ResistanceTable::first
  std::uint8_t mantissa_bits = 0;     ///< ResistanceTable::mantissa_bits
  double lowest_speed = 0.0;          ///< below it, a line through the origin replaces the cells
  double top_speed = 0.0;             ///< end of the last cell
  double split = 0.0;                 ///< a tenth of the largest force or moment, in the unit of g
  double worst_error = 0.0;           ///< where g is below `split`: absolute, in the unit of g
  double worst_relative_error = 0.0;  ///< where g is above `split`: relative to g

  /// The worst relative error: relative to g, or to `split` where g is below `split`.
  double worst_share() const;
  /// The table as the chip reads it. The result refers to the lines of this object.
  ResistanceTable view() const;
};

/// Default noise (standard deviation) of a GPS fix, m, and its default latency, s.
inline constexpr double kUsualFixNoise_m = 1.5;
inline constexpr double kUsualFixLatency_s = 0.2;

/// Upper bound of AWMR_ON_COURSE_RAD, the heading error up to which the sketches count a vehicle as
/// on course, rad.
inline constexpr double kMostOnCourse_rad = radians(45.0);

/// The firmware's numbers in the chip's form.
struct AutopilotParameters {
  ParameterBlock block{};
  /// For a model with friction at rest, a dead zone or back-EMF; absent: not compiled in.
  std::optional<RestBlock> rest;
  /// For gains that were tuned with an observer; absent: off unless the sketch enables one.
  std::optional<ObserverBlock> observer;
  float steering_max_tan_half = 0.0F;                  ///< tan(d_max/2)
  EmittedTable surge;                                  ///< table of g1; empty for kPowf
  EmittedTable yaw;                                    ///< table of g3; empty for kPowf
  ResistanceForm resistance = ResistanceForm::kTable;  ///< as in EmitOptions
  double table_error = 0.0;                            ///< bound on the errors of both tables
  float sample_time_s = 0.0F;                          ///< as in awmr_params.h
  float route_speed_mps = 0.0F;                        ///< AWMR_ROUTE_SPEED_MPS of the sketches
  double steady_error_rad = 0.0;          ///< steady heading error if the motors differ by 16 %
  float on_course_rad = 0.0F;             ///< AWMR_ON_COURSE_RAD of the sketches
  float off_course_mrad = 0.0F;           ///< AWMR_OFF_COURSE_MRAD, GpsLimits::off_course_mrad
  PositionFilter<float> position{};       ///< filter of the GPS fixes
  std::uint32_t position_latency_ms = 0;  ///< latency of the sketches' GPS
  std::set<FirmwarePart> parts;           ///< as in EmitOptions, and the observer of the gains
  std::size_t line_law = 0;               ///< as in EmitOptions
  CombinedSplit split = CombinedSplit::kRedistribute;  ///< as in EmitOptions
  std::uint32_t crc = 0;                               ///< crc32_of_parameters() of all parameters
};

/// Computes the firmware's numbers for this model and these gains. Errors: as params_header();
/// (input) small-angle allocation, front-wheel drive, or kPowf for a resistance other than the
/// power law; (refused) no table is within options.table_error.
Result<AutopilotParameters> autopilot_parameters(const Model& model, const Gains<double>& gains,
                                                 const EmitInputs& inputs,
                                                 const EmitOptions& options);

/// Text of awmr_autopilot_params.h: the optional features, the tables with their errors, the limits
/// of the safety checks, and the checksum of all parameters.
std::string autopilot_header(const AutopilotParameters& parameters);

/// A file of the emitted library.
struct EmittedFile {
  std::string path;  ///< relative to the output directory, with '/'
  std::string bytes;
};

/// Creates an Arduino library: awmr_params.h, library.properties, src/ with the C interface and the
/// unchanged control sources, examples/. It also works with PlatformIO and with plain avr-gcc and
/// -I src. The same inputs give the same bytes. Errors: as autopilot_parameters.
Result<std::vector<EmittedFile>> firmware_library(const Model& model, const Gains<double>& gains,
                                                  const EmitInputs& inputs,
                                                  const EmitOptions& options);

}  // namespace awmr
