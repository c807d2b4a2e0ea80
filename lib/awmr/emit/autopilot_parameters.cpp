#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "awmr/control/allocation.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/emit/emit.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/simulate.h"
#include "macros.h"
#include "resistance_tables.h"
#include "sketch_values.h"

namespace awmr {
namespace {

/// The default of EmitOptions::step_timeout_ms: three sample times, rounded up to milliseconds.
std::uint32_t default_step_timeout_ms(double sample_time_s) {
  return static_cast<std::uint32_t>(std::ceil(3000.0 * sample_time_s - 1e-9));
}

TableShape shape_of(const EmittedTable& table) {
  return {static_cast<std::uint32_t>(table.lines.size()), table.first, table.mantissa_bits};
}

/// Returns the value rounded to float32, as on the chip; -0 becomes 0.
float single(double value) { return static_cast<float>(value) + 0.0F; }

/// Parameters of the friction at rest, the motors' dead zone and their back-EMF; absent if the
/// model has none of them.
std::optional<RestBlock> rest_of(const Plant<double>& plant, const ModeGains& gains) {
  const bool jumps = plant.surge.coulomb > 0.0 || plant.yaw.coulomb > 0.0;
  if (!jumps && !(plant.wheel_dead_zone > 0.0) && !(plant.back_emf_s_per_m > 0.0)) return {};
  const auto at_rest = [](const Resistance<double>& law) {
    return law.rest_speed > 0.0 ? single(law.at(law.rest_speed)) : 0.0F;
  };
  const Resistance<double> surge = feed_forward(plant.surge);
  RestBlock rest{.dead_zone = single(plant.wheel_dead_zone),
                 .surge_rest_speed = single(surge.rest_speed),
                 .surge_at_rest = at_rest(surge),
                 .yaw_rest_speed = {},
                 .yaw_at_rest = {},
                 .back_emf_s_per_m = single(plant.back_emf_s_per_m)};
  for (int mode = 0; mode < kYawModeCount; ++mode) {
    const auto of_mode = static_cast<YawMode>(mode);
    const double width_radps = gains.in(of_mode).friction_width_at(steering_share<double>(of_mode));
    const Resistance<double> yaw = feed_forward(plant.yaw, width_radps);
    rest.yaw_rest_speed[mode] = single(yaw.rest_speed);
    rest.yaw_at_rest[mode] = at_rest(yaw);
  }
  return rest;
}

/// Returns the controller in float. The check sum covers the bits of derived values, so they are
/// computed in float, as by awmr.cpp in the firmware.
Controller<float> float_controller(const Plant<double>& plant, const Model& model,
                                   const Gains<double>& gains) {
  Controller<float> controller{};
  controller.mass_norm = single(plant.mass_norm);
  controller.inertia_norm = single(plant.inertia_norm);
  controller.gains = {
      {single(gains.heading.lambda), single(gains.heading.mu), single(gains.heading.epsilon)},
      {single(gains.speed.mu), single(gains.speed.epsilon)}};
  const double steering_max_rad = radians(model.vehicle.steering_max_deg);
  controller.limits.front_axle_m = single(plant.front_axle_m);
  controller.limits.half_track_m = single(plant.half_track_m);
  const Interval force = forces_beyond_dead_zone(model.vehicle.wheel_force, plant.wheel_dead_zone);
  controller.limits.force_min = single(force.lo);
  controller.limits.force_max = single(force.hi);
  controller.limits.steering_max_rad = single(steering_max_rad);
  controller.limits.steering_max_tan_half = single(tan_half(steering_max_rad));
  return controller;
}

/// Returns the parameter block, without the shapes of the resistance tables and the largest speeds,
/// which depend on the tables: add_tables() adds them.
ParameterBlock block_of(const Plant<double>& plant, const Model& model, const ModeGains& gains,
                        const EmitOptions& options) {
  const auto estimate = [&](ParameterId id) { return single(*model[id].value); };
  ParameterBlock block{};
  block.surge_alpha_beta[0] = estimate(ParameterId::kSurgeAlpha);
  block.surge_alpha_beta[1] = estimate(ParameterId::kSurgeBeta);
  block.yaw_alpha_beta[0] = estimate(ParameterId::kYawAlpha);
  block.yaw_alpha_beta[1] = estimate(ParameterId::kYawBeta);
  block.constants = prepared(float_controller(plant, model, gains.common())).constants;
  block.safety.heading_timeout_ms = options.heading_timeout_ms;
  block.safety.speed_timeout_ms = options.speed_timeout_ms;
  block.safety.command_timeout_ms = options.command_timeout_ms;
  block.safety.step_timeout_ms = options.step_timeout_ms != 0
                                     ? options.step_timeout_ms
                                     : default_step_timeout_ms(model.vehicle.sample_time_s);
  return block;
}

/// Checks that the vehicle has the exact allocation. Errors (input): it has the small-angle
/// allocation, which only the simulated controller supports.
Status check_allocation(const Model& model) {
  if (model.vehicle.allocation == AllocationForm::kExact) return {};
  return input_error(ErrorCode::kUnsupported, file_name(model) + ":/vehicle/allocation",
                     "the firmware does not support the small-angle allocation \"paper\": set "
                     "\"exact\", or emit the header alone (" +
                         option_text("header-only") + ")");
}

Status check_drive(const Plant<double>& plant, const Model& model) {
  if (plant.rear_driven > 0.0) return {};
  return input_error(ErrorCode::kUnsupported, file_name(model) + ":/vehicle/drive",
                     "the firmware supports only four driven wheels, not a front-wheel drive: "
                     "emit the header alone (" +
                         option_text("header-only") + ")");
}

/// Checks that the firmware can compute the resistance in this form. Errors (input): powf is
/// selected, but the resistance is not a power law.
Status check_family(const Plant<double>& plant, ResistanceForm form) {
  if (form == ResistanceForm::kPowf && !is_power_law(plant)) {
    return input_error(
        ErrorCode::kUnsupported, option_text("resistance"),
        "powf supports only power laws; this model has another resistance, which needs "
        "the table: leave this option out");
  }
  return {};
}

/// A resistance law of the firmware, and the data from which its table is made.
struct ChipLaw {
  std::string name;   ///< "surge" or "yaw", for messages
  ResistanceLaw law;  ///< g1, dimensionless, or g3, m
  double full_scale;  ///< largest possible force (g1) or moment (g3)
  double top;         ///< top speed of the table (table_top()), m/s or rad/s
  double rest_speed;  ///< speed below which the chip never uses the table, m/s or rad/s
};

ChipLaw chip_law(std::string name, const Resistance<double>& law, double full_scale) {
  ChipLaw chip{std::move(name), [law](double speed) { return law(speed); }, full_scale, 0.0,
               feed_forward(law).rest_speed};
  chip.top = table_top(chip.law, full_scale);
  return chip;
}

/// Returns the largest float below `top`, the end of the table's last cell: a cell does not contain
/// its end.
float largest_below(double top) { return std::nextafter(static_cast<float>(top), 0.0F); }

/// Adds the tables of the surge resistance g1 and the yaw resistance g3 to the parameters. Errors
/// (refused): the user gave `table_error`, and no table of at most 1024 lines has an error within
/// it.
Status add_tables(const ChipLaw& surge, const ChipLaw& yaw, std::optional<double> table_error,
                  AutopilotParameters& parameters) {
  const auto table = [&](const ChipLaw& chip) {
    return resistance_table(chip.name, chip.law, chip.full_scale, chip.top, table_error,
                            chip.rest_speed);
  };
  AWMR_ASSIGN_OR_RETURN(parameters.surge, table(surge));
  AWMR_ASSIGN_OR_RETURN(parameters.yaw, table(yaw));
  parameters.block.surge_table = shape_of(parameters.surge);
  parameters.block.yaw_table = shape_of(parameters.yaw);
  parameters.table_error =
      std::max({table_error.value_or(kTableError), parameters.surge.largest_relative_error(),
                parameters.yaw.largest_relative_error()});
  return {};
}

/// Returns AWMR_COMMAND_SPEED_MAX_MPS: the highest speed of the surge trials, at which the
/// resistance was measured; without such trials, the steady speed at full force. At most `limit`,
/// the largest speed that is not a fault.
float command_speed_max_mps(const Plant<double>& plant, const Model& model, double full_force,
                            float limit) {
  std::optional<double> fastest_mps;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kSurge) continue;
    fastest_mps = std::max(fastest_mps.value_or(0.0), trial.measured);
  }
  if (!fastest_mps) {
    fastest_mps = steady_rate(plant.surge, full_force, 4.0 * plant.back_emf_s_per_m);
  }
  return fastest_mps ? std::min(single(*fastest_mps), limit) : limit;
}

void set_position_filter(const Vehicle& vehicle, AutopilotParameters& parameters) {
  const double latency_s = vehicle.sensors.position_latency_s.value_or(kUsualFixLatency_s);
  parameters.position = position_filter<float>(
      vehicle.sensors.position_m.value_or(kUsualFixNoise_m), latency_s, vehicle.sample_time_s);
  parameters.position_latency_ms = static_cast<std::uint32_t>(std::lround(1000.0 * latency_s));
}

std::optional<ObserverBlock> observer_of(const ObserverGains<double>& observer,
                                         float sample_time_s) {
  if (!observer.is_on()) return {};
  return ObserverBlock{single(observer.bandwidth_radps), single(observer.yaw_max_m),
                       single(observer.surge_max), sample_time_s};
}

/// The gains of each mode; absent if all modes have the same.
std::optional<ModeGainsBlock> mode_gains_of(const Plant<double>& plant, const Model& model,
                                            const ModeGains& gains) {
  if (gains.listed_modes().empty()) return {};
  ModeGainsBlock block{};
  for (const YawMode mode : gains.listed_modes()) {
    const ObserverGains<double>& observer = gains.in(mode).observer;
    block.in[static_cast<int>(mode)] = {
        .laws = prepared(float_controller(plant, model, gains.in(mode))).constants.laws,
        .observer_radps = single(observer.bandwidth_radps),
        .observer_yaw_max_m = single(observer.yaw_max_m),
        .observer_surge_max = single(observer.surge_max)};
  }
  if (gains.has_observer()) block.observer_sample_time_s = single(model.vehicle.sample_time_s);
  return block;
}

std::uint32_t crc_of(const AutopilotParameters& parameters) {
  return crc32_of_parameters(&parameters.block, parameters.surge.lines.data(),
                             parameters.surge.lines.size(), parameters.yaw.lines.data(),
                             parameters.yaw.lines.size(),
                             parameters.rest ? &*parameters.rest : nullptr,
                             parameters.observer ? &*parameters.observer : nullptr,
                             parameters.mode_gains ? &*parameters.mode_gains : nullptr);
}

void set_sketch_values(const SketchValues& sketch, AutopilotParameters& parameters) {
  parameters.route_speed_mps = single(sketch.route_mps);
  parameters.steady_error_rad = sketch.steady_error_rad;
  parameters.on_course_rad = single(sketch.on_course_rad);
  parameters.off_course_mrad = single(sketch.off_course_mrad);
}

}  // namespace

bool is_power_law(const Plant<double>& plant) {
  const auto has_terms = [](const Resistance<double>& law) {
    return law.coulomb > 0.0 || law.quadratic > 0.0;
  };
  return !has_terms(plant.surge) && !has_terms(plant.yaw);
}

Result<AutopilotParameters> autopilot_parameters(const Model& model, const ModeGains& gains,
                                                 const EmitInputs& inputs,
                                                 const EmitOptions& options) {
  AWMR_RETURN_IF_ERROR(params_header(model, gains, inputs));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_RETURN_IF_ERROR(check_allocation(model));
  AWMR_RETURN_IF_ERROR(check_drive(plant, model));
  AWMR_RETURN_IF_ERROR(check_family(plant, options.resistance));

  const double full_force =
      4.0 * forces_beyond_dead_zone(model.vehicle.wheel_force, plant.wheel_dead_zone).hi;
  const ChipLaw surge = chip_law("surge", plant.surge, full_force);
  const ChipLaw yaw = chip_law("yaw", plant.yaw, full_force * plant.half_track_m);

  AutopilotParameters parameters;
  parameters.resistance = options.resistance;
  parameters.sample_time_s = single(model.vehicle.sample_time_s);
  set_sketch_values(sketch_values(plant, model.vehicle, gains, full_force), parameters);
  set_position_filter(model.vehicle, parameters);
  parameters.parts = parts_with(options.parts, gains);
  parameters.observer = observer_of(gains.common().observer, parameters.sample_time_s);
  parameters.split = options.split;
  parameters.line_law = options.line_law;
  parameters.block = block_of(plant, model, gains, options);
  parameters.steering_max_tan_half = parameters.block.constants.allocation.q_max;
  parameters.block.safety.speed_max_mps = largest_below(surge.top);
  parameters.block.safety.yaw_rate_max_radps = largest_below(yaw.top);
  parameters.command_speed_max_mps =
      command_speed_max_mps(plant, model, full_force, parameters.block.safety.speed_max_mps);
  if (options.resistance == ResistanceForm::kTable) {
    AWMR_RETURN_IF_ERROR(add_tables(surge, yaw, options.table_error, parameters));
  }
  parameters.rest = rest_of(plant, gains);
  parameters.mode_gains = mode_gains_of(plant, model, gains);
  parameters.crc = crc_of(parameters);
  return parameters;
}

}  // namespace awmr
