/// Firmware output: awmr_params.h, a header with the identified model and the tuned gains, and the
/// Arduino library around it.
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

/// Hashes, gains file and certificate that the emitted files name, in addition to the model's file.
struct EmitInputs {
  std::string model_sha256;               ///< SHA-256 of the model file, lower-case hexadecimal
  std::string gains_sha256;               ///< SHA-256 of the gains file, lower-case hexadecimal
  std::string gains_file = "gains.json";  ///< name without directories
  std::optional<CertifiedGains> certificate = {};  ///< robustness certificate of the gains, if any
};

/// Returns AWMR_PARAMS_SHA256: the SHA-256 of 128 characters, which are the hexadecimal SHA-256 of
/// the model followed by that of the gains.
std::string params_sha256(const EmitInputs& inputs);

/// Text of awmr_params.h: C89 and C++98 and later, in ASCII. Each value is rounded to float32 once
/// and written with nine significant digits, which read back to the same float. Errors (input): the
/// model lacks a parameter; a value is not a normal float32, or out of its range (all such values
/// are reported). Errors (refused): T2 >= T1 in float32.
Result<std::string> params_header(const Model& model, const Gains<double>& gains,
                                  const EmitInputs& inputs);

/// Method by which the firmware computes the resistances g1 and g3.
enum class ResistanceForm {
  kTable,  ///< an interpolated table in flash: much faster
  kPowf    ///< the power law by the C library's powf
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

/// Default table error, negligible compared with a model's uncertainty.
inline constexpr double kTableError = 5e-4;

/// Options of the firmware.
struct EmitOptions {
  /// kPowf if flash is scarce and the control step has time to spare; only for a power law.
  ResistanceForm resistance = ResistanceForm::kTable;
  /// Largest error of a table, > 0, relative to the larger of the resistance and a tenth of the
  /// largest force (4 F'max, surge) or moment (4 d F'max, yaw). A larger value gives a smaller
  /// table. Absent: kTableError, or the smallest error that a table achieves.
  std::optional<double> table_error = {};
  /// Parts to compile in. Each needs flash, RAM and, while in use, time in every step.
  std::set<FirmwarePart> parts = {};
  /// Law of the part kLine: its index in LineLaws.
  std::size_t line_law = 0;
  /// Combined mode, if steering or wheel forces saturate.
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// Maximum age of heading and yaw rate, ms, > 0. Longer for a slow compass.
  std::uint32_t heading_timeout_ms = 100;
  /// Maximum age of speed and position, ms, > 0; the default permits two failed fixes of a 5 Hz
  /// GPS.
  std::uint32_t speed_timeout_ms = 600;
  /// Maximum age of the last command, ms, > 0; then the motors stop. Longer for an unreliable radio
  /// link.
  std::uint32_t command_timeout_ms = 1000;
  /// Longest time between two steps, ms; 0: three sample times.
  std::uint32_t step_timeout_ms = 0;
};

/// A resistance table and its error relative to the law. Speeds are in m/s for g1, in rad/s for g3.
struct EmittedTable {
  std::vector<ResistanceLine> lines;  ///< ResistanceTable::lines
  std::uint16_t first = 0;            ///< ResistanceTable::first
  std::uint8_t mantissa_bits = 0;     ///< ResistanceTable::mantissa_bits
  double lowest_speed = 0.0;          ///< start of the first cell; below it, a line to the origin
  double top_speed = 0.0;             ///< end of the last cell
  double split = 0.0;                 ///< a tenth of the largest force or moment, in the unit of g
  double worst_error = 0.0;           ///< where g is below `split`: absolute, in the unit of g
  double worst_relative_error = 0.0;  ///< where g is above `split`: relative to g

  /// The worst error relative to g, or to `split` where g is below it.
  double worst_share() const;
  /// The table in the chip's form. It refers to this object's lines.
  ResistanceTable view() const;
};

/// Default noise of a fix, m, and its latency, s.
inline constexpr double kUsualFixNoise_m = 1.5;
inline constexpr double kUsualFixLatency_s = 0.2;

/// Upper bound of AWMR_ON_COURSE_RAD, the steady heading error that the sketches accept, rad.
inline constexpr double kMostOnCourse_rad = radians(45.0);

/// The firmware's numbers in the chip's form.
struct AutopilotParameters {
  ParameterBlock block{};
  /// For a model with friction at rest, a dead zone or back-EMF; absent: not compiled in.
  std::optional<RestBlock> rest;
  /// For gains that were tuned with an observer; absent: off unless the sketch enables one.
  std::optional<ObserverBlock> observer;
  float steering_max_tan_half = 0.0F;                  ///< tan(d_max/2)
  EmittedTable surge;                                  ///< of g1; without lines for kPowf
  EmittedTable yaw;                                    ///< of g3; without lines for kPowf
  ResistanceForm resistance = ResistanceForm::kTable;  ///< as in EmitOptions
  double table_error = 0.0;                            ///< bound for both tables
  float sample_time_s = 0.0F;                          ///< as in awmr_params.h
  float route_speed_mps = 0.0F;                        ///< AWMR_ROUTE_SPEED_MPS of the sketches
  double steady_error_rad = 0.0;          ///< heading error with motors that differ by 16 %
  float on_course_rad = 0.0F;             ///< AWMR_ON_COURSE_RAD of the sketches
  float off_course_mrad = 0.0F;           ///< AWMR_OFF_COURSE_MRAD, GpsLimits::off_course_mrad
  PositionFilter<float> position{};       ///< filter of the GPS fixes
  std::uint32_t position_latency_ms = 0;  ///< latency of the sketches' GPS
  std::set<FirmwarePart> parts;           ///< as in EmitOptions, and the observer of the gains
  std::size_t line_law = 0;               ///< as in EmitOptions
  CombinedSplit split = CombinedSplit::kRedistribute;  ///< as in EmitOptions
  std::uint32_t crc = 0;                               ///< crc32_of_parameters() of all parameters
};

/// Computes the firmware's numbers for this model and these gains. Errors: as params_header;
/// (input) a friction model that the firmware does not support; (refused) a table that cannot be
/// within its bound.
Result<AutopilotParameters> autopilot_parameters(const Model& model, const Gains<double>& gains,
                                                 const EmitInputs& inputs,
                                                 const EmitOptions& options);

/// Text of awmr_autopilot_params.h: the parts, tables with their errors, limits of the safety
/// checks, the check sum over all parameters.
std::string autopilot_header(const AutopilotParameters& parameters);

/// A file of the emitted library.
struct EmittedFile {
  std::string path;  ///< relative, with '/'
  std::string bytes;
};

/// Creates an Arduino library: awmr_params.h, library.properties, src/ with the C interface and the
/// unchanged control sources, examples/. It also works with PlatformIO and with plain avr-gcc and
/// -I src. The same inputs give the same bytes. Errors: as autopilot_parameters.
Result<std::vector<EmittedFile>> firmware_library(const Model& model, const Gains<double>& gains,
                                                  const EmitInputs& inputs,
                                                  const EmitOptions& options);

}  // namespace awmr
