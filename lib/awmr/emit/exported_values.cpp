#include "exported_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "awmr/model/si_units.h"
#include "friction_widths.h"

namespace awmr {
namespace {

/// Converts "surge.alpha" or "/surge/alpha" to an identifier.
std::string identifier(std::string_view name) {
  std::string text(name);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '.' || c == '/'; }, '_');
  return text;
}

ExportedValue exported(std::string name, std::string_view unit, std::string meaning,
                       const Estimate& estimate) {
  return {.name = std::move(name),
          .value = *estimate.value,
          .unit = std::string(unit),
          .meaning = std::move(meaning),
          .origin = fmt::format("{}, {}", name_in(kSourceNames, estimate.source), estimate.method),
          .std_error = estimate.std_error,
          .ci95 = estimate.ci95};
}

void export_parameters(const Model& model, std::vector<ExportedValue>& values) {
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    const bool is_there = has(model.vehicle, parameter.id) && !is_absent_term(model, parameter.id);
    if (!estimate.value || !is_there) continue;
    values.push_back(exported(identifier(parameter.name), parameter.unit,
                              fmt::format("{}: {}", parameter.symbol, parameter.meaning),
                              estimate));
  }
  for (const SiQuantity& quantity : si_quantities(model)) {
    // Given quantities (the mass m) are skipped here, because export_vehicle() lists them.
    if (quantity.estimate.source == Source::kGiven) continue;
    values.push_back(exported("si" + identifier(quantity.pointer), quantity.unit,
                              fmt::format("{} in SI units", quantity.name), quantity.estimate));
  }
}

void export_vehicle(const Vehicle& vehicle, std::vector<ExportedValue>& values) {
  const auto add = [&values](const char* name, double value, const char* unit,
                             const char* meaning) {
    values.push_back({.name = name,
                      .value = value,
                      .unit = unit,
                      .meaning = meaning,
                      .origin = "given, vehicle"});
  };
  add("mass_kg", vehicle.mass_kg, "kg", "m: mass of the vehicle as it drives, with batteries");
  add("length_m", vehicle.length_m, "m", "length of the body");
  add("width_m", vehicle.width_m, "m", "overall width");
  if (vehicle.has_steering()) {
    add("front_axle_m", vehicle.front_axle_m, "m", "l_f: centre of gravity to front axle");
  }
  add("half_track_m", vehicle.half_track_m, "m", "d: centre line to the middle of a wheel");
  add("wheel_force_min", vehicle.wheel_force.lo, "1",
      "F': smallest force of a wheel, divided by F_max");
  add("wheel_force_max", vehicle.wheel_force.hi, "1",
      "F': largest force of a wheel, divided by F_max");
  if (vehicle.has_steering()) {
    add("steering_max_deg", vehicle.steering_max_deg, "deg",
        "d_max: largest steering angle to either side");
    add("steering_max_rate_degps", vehicle.steering_max_rate_degps, "deg/s",
        "largest rate of the steering angle");
  }
  add("sample_time_s", vehicle.sample_time_s, "s", "T_s: time between two steps of the controller");
}

/// Adds the gains of one mode (`mode`, which becomes part of the names). Without `mode`: the gains
/// of all modes without gains of their own. `has_observer`: also adds the observer, with zeros if
/// these gains have none. `has_widths`: also adds the friction widths w0, the yaw rates below which
/// the heading law feeds Coulomb friction forward smoothly.
void export_gains(const Gains<double>& gains, std::optional<YawMode> mode, bool has_observer,
                  bool has_widths, std::vector<ExportedValue>& values) {
  const auto add = [&](std::string name, double value, const char* unit, std::string meaning) {
    values.push_back(
        {.name = name + (mode ? fmt::format("_{}", name_of(*mode)) : ""),
         .value = value,
         .unit = unit,
         .meaning = meaning + (mode ? fmt::format(", in {} mode", name_of(*mode)) : ""),
         .origin = "gains"});
  };
  add("heading_lambda", gains.heading.lambda, "1/s", "lambda: slope of the sliding surface");
  add("heading_mu", gains.heading.mu, "rad/s^2", "mu: largest corrective yaw acceleration");
  add("heading_epsilon", gains.heading.epsilon, "rad/s",
      "epsilon: half width of the heading law's boundary layer");
  if (has_widths) {
    for (const FrictionWidth& width : friction_widths(gains, mode)) {
      add(width.is_second ? "heading_combined_friction_width" : "heading_friction_width",
          width.width_radps, "rad/s",
          fmt::format("{}{}{}", width.symbol, width.symbol.empty() ? "" : ": ", width.meaning));
    }
  }
  add("speed_mu", gains.speed.mu, "m/s^2", "mu_s: largest corrective acceleration");
  add("speed_epsilon", gains.speed.epsilon, "m/s",
      "eps_s: half width of the speed law's boundary layer");
  if (!has_observer) return;
  add("observer_bandwidth_radps", gains.observer.bandwidth_radps, "rad/s",
      "L: bandwidth of the disturbance observer");
  add("observer_yaw_max_m", gains.observer.yaw_max_m, "m",
      "largest moment that the observer compensates, divided by F_max");
  add("observer_surge_max", gains.observer.surge_max, "1",
      "largest force that the observer compensates, divided by F_max");
}

}  // namespace

std::vector<ExportedValue> exported_values(const ExportSource& source) {
  std::vector<ExportedValue> values;
  export_parameters(source.model, values);
  export_vehicle(source.model.vehicle, values);
  if (!source.gains) return values;
  const ModeGains& gains = *source.gains;
  export_gains(gains.common(), std::nullopt, gains.common().observer.is_on(),
               gains.listed_modes().empty(), values);
  for (const YawMode mode : gains.listed_modes()) {
    export_gains(gains.in(mode), mode, gains.has_observer(), true, values);
  }
  return values;
}

std::string uncertainty_text(const ExportedValue& value) {
  std::string text;
  if (value.std_error) text = fmt::format("std error {:.2g}", *value.std_error);
  if (!value.ci95) return text;
  return fmt::format("{}{}95 % [{:.4g}, {:.4g}]", text, text.empty() ? "" : ", ", value.ci95->lo,
                     value.ci95->hi);
}

}  // namespace awmr
