#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>

#include "awmr/emit/emit.h"
#include "awmr/simulate/scenario.h"
#include "c_text.h"

namespace awmr {
namespace {

constexpr std::string_view kIntro =
    R"(/* awmr_autopilot_params.h, made by awmr {}: tables of the resistances, limits of the safety
   checks, values for the sketches, and a check sum. Values of the model and the gains are in
   awmr_params.h. The check sum covers the tables, the safety limits and the controller's parameters
   of both files: awmr_init() reports if one of them was edited. */
#ifndef AWMR_AUTOPILOT_PARAMS_H
#define AWMR_AUTOPILOT_PARAMS_H

/* 1: the firmware computes the resistances by interpolated tables in flash; 0: by powf */
#define AWMR_RESISTANCE_TABLE {}

/* tan(d_max/2) with d_max = AWMR_STEERING_MAX_RAD */
#define AWMR_STEERING_MAX_TAN_HALF {}

/* Largest measured speeds |u| (forward) and |v| (to the left), m/s, and yaw rates |r|, rad/s, that
   are not a fault: the ends of the resistance tables, which the motors cannot reach. Largest
   commanded speed: AWMR_COMMAND_SPEED_MAX_MPS */
#define AWMR_SPEED_MAX_MPS {}
#define AWMR_YAW_RATE_MAX_RADPS {}
/* ms: largest age of heading and yaw rate, of speed and position, and of the last command; longest
   time between two steps. More is a fault */
#define AWMR_HEADING_TIMEOUT_MS {}UL
#define AWMR_SPEED_TIMEOUT_MS {}UL
#define AWMR_COMMAND_TIMEOUT_MS {}UL
#define AWMR_STEP_TIMEOUT_MS {}UL
/* Largest speed that the sketches accept from the operator, m/s: the highest speed of the surge
   trials, because the model was not measured above it; without such trials, the speed at full
   force */
#define AWMR_COMMAND_SPEED_MAX_MPS {}
/* Speed of the sketch WaypointFollowing, m/s: 1, or 60 % of the speed at full force if that is
   less */
#define AWMR_ROUTE_SPEED_MPS {}
/* Largest steady heading error that the sketches accept, rad: twice the error that motors with 16 %
   different forces cause with these gains, at least 15 and at most 45 deg */
#define AWMR_ON_COURSE_RAD {}
/* Limit of the integral of (heading error - AWMR_ON_COURSE_RAD) over the distance driven, m rad;
   beyond it the sketches report fault 17. The limit is 10 plus the integral of the widest turn by
   180 deg that vehicle and gains allow, at most 90 */
#define AWMR_OFF_COURSE_MRAD {}
/* AWMR_SAMPLE_TIME_S as text, for the header of logs */
#define AWMR_SAMPLE_TIME_TEXT "{}"
/* CRC-32 of the controller's parameters and of the tables, as stored in flash */
#define AWMR_PARAMETERS_CRC32 0x{:08X}UL
)";

constexpr std::string_view kTable = R"(
/* {} resistance: {} straight lines (slope, offset): one from the origin, then {} per doubling of
   the speed, from {:g} to {:g} {}. Largest error, measured in float32 at 64 places of each cell:
   {:.2e} {} where the resistance is below {:g} (bound {:.2e}), {:.2e} relative to the resistance
   above (bound {:.2e}). */
#define {}_COUNT {}
#define {}_FIRST {}
#define {}_MANTISSA_BITS {}
#define {}_LINES {{ \
)";

constexpr std::string_view kParts = R"(
/* 1: this optional part is compiled in; awmr.h describes each */
{}/* Guidance law for lines: {}, by its index in src/awmr/control/guidance/line_laws.h */
#define AWMR_LINE_LAW {}
/* Combined mode: 1: steering and wheel forces each make half of the yaw moment, and what one cannot
   make at its limit is lost; 0: the other one makes it */
#define AWMR_FIXED_HALF {}
)";

constexpr std::string_view kPosition = R"(
/* Position estimate from the fixes of a GPS (src/awmr/control/position_estimate.h). Variance of a
   fix along one axis, m^2: the square of noise/position_m in vehicle.json, else of 1.5 m. Time
   between a fix and its sentence, ms: from latency_s/position, else 200 */
#define AWMR_FIX_VARIANCE_M2 {}
#define AWMR_FIX_LATENCY_MS {}UL
/* Growth of the variance of the estimated position per step, m^2 */
#define AWMR_DRIFT_M2 {}
#define AWMR_SAMPLE_RATE_HZ {}
/* Steps between two stored positions of the travelled path; steps over which a correction is
   spread */
#define AWMR_TRAVELLED_STRIDE {}
#define AWMR_TRAVELLED_STRIDE_INVERSE {}
#define AWMR_CORRECTION_STEPS {}
#define AWMR_CORRECTION_STEPS_INVERSE {}
/* 1: the work on a fix is spread over several steps, because the sample time is short */
#define AWMR_SPREADS_FIXES {}
)";

std::string position_text(const AutopilotParameters& parameters) {
  const auto literal = [](float value) { return float_literal(static_cast<double>(value)); };
  const PositionFilter<float>& filter = parameters.position;
  return fmt::format(kPosition, literal(filter.fix_variance_m2), parameters.position_latency_ms,
                     literal(filter.drift_m2), literal(filter.sample_rate_hz), filter.stride,
                     literal(filter.stride_inverse), filter.spread_steps,
                     literal(filter.spread_inverse), filter.spreads_work ? 1 : 0);
}

/// Name of the macro of an optional part: AWMR_WITH_SLOW_DOWN for slow_down.
std::string macro_of(std::string_view part) {
  std::string macro = "AWMR_WITH_";
  std::transform(part.begin(), part.end(), std::back_inserter(macro),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return macro;
}

std::string parts_text(const AutopilotParameters& parameters) {
  std::string lines;
  for (const auto& [name, part] : kFirmwarePartNames) {
    lines += fmt::format("#define {} {}\n", macro_of(name), parameters.parts.count(part));
  }
  return fmt::format(kParts, lines, line_law_names()[parameters.line_law], parameters.line_law,
                     parameters.split == CombinedSplit::kFixedHalf ? 1 : 0);
}

constexpr std::string_view kRest = R"(
/* The firmware compensates friction at rest, a dead zone and the back-EMF of the motors. Below
   AWMR_SURGE_REST_SPEED (m/s) and AWMR_YAW_REST_SPEED (rad/s; differential, steering, combined) a
   resistance is the straight line from the origin to its value at that speed (..._AT_REST). The
   allocation requests wheel forces between AWMR_ALLOCATED_FORCE_MIN and _MAX: the force limits,
   reduced by the dead zone. */
#define AWMR_FRICTION_AT_REST 1
#define AWMR_DEAD_ZONE {}
#define AWMR_SURGE_REST_SPEED {}
#define AWMR_SURGE_AT_REST {}
#define AWMR_YAW_REST_SPEED {}
#define AWMR_YAW_AT_REST {}
#define AWMR_BACK_EMF_S_PER_M {}
#define AWMR_ALLOCATED_FORCE_MIN {}
#define AWMR_ALLOCATED_FORCE_MAX {}
)";
constexpr std::string_view kNoRest = R"(
/* 1: the firmware compensates friction at rest, a dead zone or the back-EMF of the motors */
#define AWMR_FRICTION_AT_REST 0
#define AWMR_ALLOCATED_FORCE_MIN AWMR_WHEEL_FORCE_MIN
#define AWMR_ALLOCATED_FORCE_MAX AWMR_WHEEL_FORCE_MAX
)";

std::string rest_text(const AutopilotParameters& parameters) {
  if (!parameters.rest) return std::string(kNoRest);
  const auto literal = [](float value) { return float_literal(static_cast<double>(value)); };
  const auto by_mode = [&](const float(&values)[kYawModeCount]) {
    return fmt::format("{{{}, {}, {}}}", literal(values[0]), literal(values[1]),
                       literal(values[2]));
  };
  const RestBlock& rest = *parameters.rest;
  const AllocationConstants<float>& allocation = parameters.block.constants.allocation;
  return fmt::format(kRest, literal(rest.dead_zone), literal(rest.surge_rest_speed),
                     literal(rest.surge_at_rest), by_mode(rest.yaw_rest_speed),
                     by_mode(rest.yaw_at_rest), literal(rest.back_emf_s_per_m),
                     literal(allocation.force_min), literal(allocation.force_max));
}

struct TableText {
  std::string_view title;
  std::string_view macro;
  std::string_view speed_unit;
  std::string_view unit;
};

std::string table_text(const EmittedTable& table, const TableText& names, double error_share) {
  const std::string_view macro = names.macro;
  std::string text = fmt::format(
      kTable, names.title, table.lines.size(), 1 << table.mantissa_bits, table.lowest_speed,
      table.top_speed, names.speed_unit, table.worst_error, names.unit, table.split,
      error_share * table.split, table.worst_relative_error, error_share, macro, table.lines.size(),
      macro, table.first, macro, table.mantissa_bits, macro);
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    const bool last = i + 1 == table.lines.size();
    text +=
        fmt::format("  {{{}, {}}}{} \\\n", float_literal(static_cast<double>(table.lines[i].slope)),
                    float_literal(static_cast<double>(table.lines[i].offset)), last ? "" : ",");
  }
  return text + "}\n";
}

}  // namespace

std::string autopilot_header(const AutopilotParameters& parameters) {
  const ParameterBlock& block = parameters.block;
  const bool by_table = parameters.resistance == ResistanceForm::kTable;
  std::string text =
      fmt::format(kIntro, version(), by_table ? 1 : 0,
                  float_literal(static_cast<double>(parameters.steering_max_tan_half)),
                  float_literal(static_cast<double>(block.safety.speed_max_mps)),
                  float_literal(static_cast<double>(block.safety.yaw_rate_max_radps)),
                  block.safety.heading_timeout_ms, block.safety.speed_timeout_ms,
                  block.safety.command_timeout_ms, block.safety.step_timeout_ms,
                  float_literal(static_cast<double>(parameters.command_speed_max_mps)),
                  float_literal(static_cast<double>(parameters.route_speed_mps)),
                  float_literal(static_cast<double>(parameters.on_course_rad)),
                  float_literal(static_cast<double>(parameters.off_course_mrad)),
                  parameters.sample_time_s, parameters.crc);
  text += parts_text(parameters);
  text += rest_text(parameters);
  text += position_text(parameters);
  if (by_table) {
    text += table_text(parameters.surge, {"Surge", "AWMR_SURGE_TABLE", "m/s", "of F_max"},
                       parameters.table_error);
    text +=
        table_text(parameters.yaw, {"Yaw", "AWMR_YAW_TABLE", "rad/s", "m"}, parameters.table_error);
  }
  return text + "\n#endif /* AWMR_AUTOPILOT_PARAMS_H */\n";
}

}  // namespace awmr
