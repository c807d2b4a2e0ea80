#include <cmath>

#include "awmr/control/allocation.h"
#include "awmr/core/units.h"
#include "awmr/emit/emit.h"
#include "resistance_tables.h"

namespace awmr {
namespace {

/// Three sample times, whole milliseconds.
std::uint32_t default_step_timeout_ms(double sample_time_s) {
  return static_cast<std::uint32_t>(std::ceil(3000.0 * sample_time_s - 1e-9));
}

TableShape shape_of(const EmittedTable& table) {
  return {static_cast<std::uint32_t>(table.values.size()), table.first, table.mantissa_bits,
          table.slope_at_rest};
}

ParameterBlock block_of(const Plant<double>& plant, const Model& model, const Gains<double>& gains,
                        const EmitOptions& options) {
  const auto single = [](double value) { return static_cast<float>(value) + 0.0F; };
  const auto estimate = [&](ParameterId id) { return single(*model[id].value); };
  ParameterBlock block{};
  block.surge_alpha_beta[0] = estimate(ParameterId::kSurgeAlpha);
  block.surge_alpha_beta[1] = estimate(ParameterId::kSurgeBeta);
  block.yaw_alpha_beta[0] = estimate(ParameterId::kYawAlpha);
  block.yaw_alpha_beta[1] = estimate(ParameterId::kYawBeta);
  // In float from here on, as a compiler folds awmr.cpp's expressions.
  Controller<float> controller{};
  controller.mass_norm = single(plant.mass_norm);
  controller.inertia_norm = single(plant.inertia_norm);
  controller.gains = {
      {single(gains.heading.lambda), single(gains.heading.mu), single(gains.heading.epsilon)},
      {single(gains.speed.mu), single(gains.speed.epsilon)}};
  const double steering_max_rad = radians(model.vehicle.steering_max_deg);
  controller.limits.front_axle_m = single(plant.front_axle_m);
  controller.limits.half_track_m = single(plant.half_track_m);
  controller.limits.force_min = single(model.vehicle.wheel_force.lo);
  controller.limits.force_max = single(model.vehicle.wheel_force.hi);
  controller.limits.steering_max_rad = single(steering_max_rad);
  controller.limits.steering_max_tan_half = single(tan_half(steering_max_rad));
  block.constants = prepared(controller).constants;
  block.safety.heading_timeout_ms = options.heading_timeout_ms;
  block.safety.speed_timeout_ms = options.speed_timeout_ms;
  block.safety.command_timeout_ms = options.command_timeout_ms;
  block.safety.step_timeout_ms = options.step_timeout_ms != 0
                                     ? options.step_timeout_ms
                                     : default_step_timeout_ms(model.vehicle.sample_time_s);
  return block;
}

}  // namespace

Result<AutopilotParameters> autopilot_parameters(const Model& model, const Gains<double>& gains,
                                                 const EmitInputs& inputs,
                                                 const EmitOptions& options) {
  if (const auto checked = params_header(model, gains, inputs); !checked) {
    return tl::unexpected(checked.error());
  }
  const auto plant = model.plant();
  if (!plant) return tl::unexpected(plant.error());
  if (plant->wheel_dead_zone > 0.0) {
    return input_error(
        inputs.model_file + ":/wheel/dead_zone",
        "the firmware does not make up for a dead zone of the wheels; emit the header "
        "alone (--header-only) and add AWMR_WHEEL_DEAD_ZONE where the motors are "
        "written, or identify a family without it");
  }
  const Resistance<double>& surge_law = plant->surge;
  const Resistance<double>& yaw_law = plant->yaw;
  if (surge_law.coulomb > 0.0 || yaw_law.coulomb > 0.0) {
    return input_error(
        inputs.model_file + (surge_law.coulomb > 0.0 ? ":/surge/coulomb" : ":/yaw/coulomb"),
        "the firmware does not make up for friction at rest, as the simulated controller does; "
        "emit "
        "the header alone (--header-only), or identify a family without it");
  }
  if (options.resistance == ResistanceForm::kPowf &&
      (surge_law.quadratic > 0.0 || yaw_law.quadratic > 0.0)) {
    return input_error("--resistance",
                       "powf knows the power law alone; this model's family needs the table");
  }
  const ResistanceLaw surge = [&](double u) { return surge_law(u); };
  const ResistanceLaw yaw = [&](double r) { return yaw_law(r); };
  const double full_force = 4.0 * model.vehicle.wheel_force.hi;
  const double full_moment_m = full_force * plant->half_track_m;
  const double speed_top = table_top(surge, full_force);
  const double rate_top = table_top(yaw, full_moment_m);

  AutopilotParameters parameters;
  parameters.resistance = options.resistance;
  parameters.table_error = options.table_error;
  parameters.block = block_of(*plant, model, gains, options);
  parameters.steering_max_tan_half = 2.0F * parameters.block.constants.allocation.h_max;
  // The largest float below the last entry: a speed at the top has no cell above it.
  parameters.block.safety.speed_max_mps = std::nextafter(static_cast<float>(speed_top), 0.0F);
  parameters.block.safety.yaw_rate_max_radps = std::nextafter(static_cast<float>(rate_top), 0.0F);
  if (options.resistance == ResistanceForm::kTable) {
    auto table = resistance_table("surge", surge, full_force, speed_top, options.table_error);
    if (!table) return tl::unexpected(table.error());
    parameters.surge = std::move(*table);
    table = resistance_table("yaw", yaw, full_moment_m, rate_top, options.table_error);
    if (!table) return tl::unexpected(table.error());
    parameters.yaw = std::move(*table);
    parameters.block.surge_table = shape_of(parameters.surge);
    parameters.block.yaw_table = shape_of(parameters.yaw);
  }
  parameters.crc = crc32_of_parameters(&parameters.block, parameters.surge.values.data(),
                                       parameters.surge.values.size(), parameters.yaw.values.data(),
                                       parameters.yaw.values.size());
  return parameters;
}

}  // namespace awmr
