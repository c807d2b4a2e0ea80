/// The firmware: awmr_params.h, the identified model and the tuned gains as a header, and the
/// Arduino library around it.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/control/parameters_block.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/model/certificate.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"

namespace awmr {

/// What the emitted files name as their origin, beside the model's own file name.
struct EmitInputs {
  std::string model_sha256;               ///< of the bytes of the model's file, lower-case digits
  std::string gains_sha256;               ///< of the bytes of the gains' file, lower-case digits
  std::string gains_file = "gains.json";  ///< without its folders
  std::optional<CertifiedGains> certificate = {};  ///< of the gains; absent: they have none
};

/// AWMR_PARAMS_SHA256: SHA-256 of the 128 characters that the model's and the gains' SHA-256 make
/// in lower-case hexadecimal, the model's first.
std::string params_sha256(const EmitInputs& inputs);

/// The bytes of awmr_params.h: C89 and C++98 and later, in ASCII. Each value is rounded to float32
/// once and written with nine significant digits, which read back to the same float.
/// Errors (input): the model lacks a parameter; a value is not a normal float32, or out of its
/// range (every such value at once). Errors (refused): T2 >= T1 as float32 sees it.
Result<std::string> params_header(const Model& model, const Gains<double>& gains,
                                  const EmitInputs& inputs);

/// How the firmware computes the resistances g1 and g3.
enum class ResistanceForm {
  kTable,  ///< an interpolated table in flash: the faster by far
  kPowf    ///< the power law by the C library's powf
};
inline constexpr NameTable<ResistanceForm, 2> kResistanceFormNames{
    {{"table", ResistanceForm::kTable}, {"powf", ResistanceForm::kPowf}}};

/// What a firmware can do beyond holding a heading and going to waypoints.
enum class FirmwarePart {
  kLine,       ///< follow a line or polyline
  kPath,       ///< follow a path in time
  kSlowDown,   ///< slow down before the last point
  kAvoidance,  ///< steer clear of obstacles
  kShaping,    ///< limit rate and acceleration of the heading wanted
  kObserver    ///< take the disturbance that is seen off the command
};
inline constexpr NameTable<FirmwarePart, 6> kFirmwarePartNames{
    {{"line", FirmwarePart::kLine},
     {"path", FirmwarePart::kPath},
     {"slow_down", FirmwarePart::kSlowDown},
     {"avoidance", FirmwarePart::kAvoidance},
     {"shaping", FirmwarePart::kShaping},
     {"observer", FirmwarePart::kObserver}}};

/// The error of a table that is small beside what a model knows of its vehicle.
inline constexpr double kTableError = 5e-4;

/// How the firmware is made.
struct EmitOptions {
  /// kPowf where the flash is short and the control step has time to spare; it takes a power law.
  ResistanceForm resistance = ResistanceForm::kTable;
  /// > 0: the largest error of a table, as a share of the resistance itself or, where that is less,
  /// of a tenth of the largest force (4 F'max for surge) or moment (4 d F'max for yaw). Larger: a
  /// smaller table. Absent: kTableError or, where no table is as good, that of the best one.
  std::optional<double> table_error = {};
  /// Compiled in. Each takes flash, RAM and, once it is in use, time of every step.
  std::set<FirmwarePart> parts = {};
  /// What the combined mode does with a path that saturates.
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// ms, > 0: oldest heading and yaw rate to steer by. Longer for a slow compass.
  std::uint32_t heading_timeout_ms = 100;
  /// ms, > 0: oldest speed and position to steer by; the default lets two fixes of a 5 Hz GPS fail.
  std::uint32_t speed_timeout_ms = 600;
  /// ms, > 0: longest silence of whoever gives the reference, before the motors stop. Longer over
  /// an unreliable radio link.
  std::uint32_t command_timeout_ms = 1000;
  /// ms: longest time between two steps; 0: three sample times.
  std::uint32_t step_timeout_ms = 0;
};

/// A resistance table and how far it is from the law. Speeds are in m/s for g1, in rad/s for g3.
struct EmittedTable {
  std::vector<ResistanceLine> lines;  ///< ResistanceTable::lines
  std::uint16_t first = 0;            ///< ResistanceTable::first
  std::uint8_t mantissa_bits = 0;     ///< ResistanceTable::mantissa_bits
  double lowest_speed = 0.0;          ///< of the first cell; below it the chord to the origin
  double top_speed = 0.0;             ///< at the end of the last cell
  double split = 0.0;                 ///< a tenth of the largest force or moment, in the unit of g
  double worst_error = 0.0;           ///< where g is below `split`: absolute, in the unit of g
  double worst_relative_error = 0.0;  ///< where g is above `split`: a share of g

  /// The worst error as a share of g, or of `split` where g is below it.
  double worst_share() const;
  /// The table as the chip reads it. It refers to this object's lines.
  ResistanceTable view() const;
};

/// The numbers of the firmware as the chip holds them.
struct AutopilotParameters {
  ParameterBlock block{};
  /// For a model with friction at rest, a dead zone or back-EMF; absent: the firmware is without.
  std::optional<RestBlock> rest;
  /// Of gains that were tuned with an observer; absent: none works unless the sketch switches one on.
  std::optional<ObserverBlock> observer;
  float steering_max_tan_half = 0.0F;                  ///< tan(d_max/2)
  EmittedTable surge;                                  ///< of g1; without lines for kPowf
  EmittedTable yaw;                                    ///< of g3; without lines for kPowf
  ResistanceForm resistance = ResistanceForm::kTable;  ///< as in EmitOptions
  double table_error = 0.0;                            ///< that both tables keep to
  float sample_time_s = 0.0F;                          ///< as in awmr_params.h
  float route_speed_mps = 0.0F;  ///< of the sketches: 1 m/s, at most 60 % of what can be reached
  std::set<FirmwarePart> parts;  ///< as in EmitOptions, and the observer of the gains
  CombinedSplit split = CombinedSplit::kRedistribute;  ///< as in EmitOptions
  std::uint32_t crc = 0;                               ///< crc32_of_parameters() of all of it
};

/// The numbers of the firmware for this model and these gains.
/// Errors: as params_header; (input) a family of resistance that the firmware does not know;
/// (refused) a table that cannot be within its bound.
Result<AutopilotParameters> autopilot_parameters(const Model& model, const Gains<double>& gains,
                                                 const EmitInputs& inputs,
                                                 const EmitOptions& options);

/// The bytes of awmr_autopilot_params.h: the parts, tables with their error, limits of the safety
/// checks, the check sum over all parameters.
std::string autopilot_header(const AutopilotParameters& parameters);

/// A file of the emitted library.
struct EmittedFile {
  std::string path;  ///< relative, with '/'
  std::string bytes;
};

/// An Arduino library: awmr_params.h, library.properties, src/ with the C interface and the control
/// sources as they are, examples/. Also valid for PlatformIO and for plain avr-gcc with -I src.
/// The same bytes for the same inputs. Errors: as autopilot_parameters.
Result<std::vector<EmittedFile>> firmware_library(const Model& model, const Gains<double>& gains,
                                                  const EmitInputs& inputs,
                                                  const EmitOptions& options);

}  // namespace awmr
