#include "macros.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "friction_widths.h"

namespace awmr {
namespace {

Macro parameter_macro(std::string name, const Model& model, ParameterId id, MacroRange range,
                      const std::string& file) {
  const ParameterInfo& parameter = info(id);
  const Estimate& estimate = model[id];
  const std::string error =
      estimate.std_error ? fmt::format("std error {:.2g}", *estimate.std_error) : "no std error";
  return {.name = std::move(name),
          .value = *estimate.value,
          .comment = fmt::format("{}, {}: {}; {}, {}, {}", parameter.symbol, parameter.unit,
                                 parameter.meaning, name_in(kSourceNames, estimate.source),
                                 estimate.method, error),
          .place = fmt::format("{}:{}/value", file, parameter.pointer),
          .range = range};
}

void add_parameters(std::vector<Macro>& macros, const Model& model, const std::string& file) {
  const auto add = [&](std::string name, ParameterId id, MacroRange range) {
    macros.push_back(parameter_macro(std::move(name), model, id, range, file));
  };
  add("AWMR_SURGE_ALPHA", ParameterId::kSurgeAlpha, MacroRange::kPositive);
  add("AWMR_SURGE_BETA", ParameterId::kSurgeBeta, MacroRange::kNotNegative);
  add("AWMR_YAW_ALPHA", ParameterId::kYawAlpha, MacroRange::kPositive);
  add("AWMR_YAW_BETA", ParameterId::kYawBeta, MacroRange::kNotNegative);
  add("AWMR_SWAY_ALPHA", ParameterId::kSwayAlpha, MacroRange::kPositive);
  add("AWMR_MASS_NORM", ParameterId::kMassNorm, MacroRange::kPositive);
  add("AWMR_INERTIA_NORM", ParameterId::kInertiaNorm, MacroRange::kPositive);
  // Terms that only resistance families other than the power law have, each if it is not 0. So the
  // header of a model with power laws has none of them.
  const std::pair<const char*, ParameterId> terms[] = {
      {"AWMR_SURGE_COULOMB", ParameterId::kSurgeCoulomb},
      {"AWMR_SURGE_QUADRATIC", ParameterId::kSurgeQuadratic},
      {"AWMR_YAW_COULOMB", ParameterId::kYawCoulomb},
      {"AWMR_YAW_QUADRATIC", ParameterId::kYawQuadratic},
      {"AWMR_WHEEL_DEAD_ZONE", ParameterId::kWheelDeadZone},
      {"AWMR_MOTOR_BACK_EMF", ParameterId::kBackEmf}};
  for (const auto& [name, id] : terms) {
    if (model[id].value != 0.0) add(name, id, MacroRange::kPositive);
  }
}

void add_vehicle(std::vector<Macro>& macros, const Vehicle& vehicle, const std::string& file) {
  const auto add = [&](std::string name, double value, std::string_view comment,
                       std::string_view key, MacroRange range = MacroRange::kPositive) {
    macros.push_back({std::move(name), value, fmt::format("{}; given, vehicle", comment),
                      fmt::format("{}:/vehicle/{}", file, key), range});
  };
  add("AWMR_FRONT_AXLE_M", vehicle.front_axle_m, "l_f, m: centre of gravity to front axle",
      "front_axle_m");
  add("AWMR_HALF_TRACK_M", vehicle.half_track_m, "d, m: centre line to a wheel", "half_track_m");
  add("AWMR_WHEEL_FORCE_MIN", vehicle.wheel_force.lo,
      "F'min, 1: smallest force of one wheel, divided by F_max", "wheel_force/min",
      MacroRange::kAnySign);
  add("AWMR_WHEEL_FORCE_MAX", vehicle.wheel_force.hi,
      "F'max, 1: largest force of one wheel, divided by F_max", "wheel_force/max");
  add("AWMR_STEERING_MAX_RAD", radians(vehicle.steering_max_deg),
      vehicle.has_steering() ? "d_max, rad: stop of the front wheels, either side"
                             : "d_max, rad: there is no steering",
      "steering/max_deg",
      vehicle.has_steering() ? MacroRange::kPositive : MacroRange::kNotNegative);
  add("AWMR_SAMPLE_TIME_S", vehicle.sample_time_s, "T_s, s: sample time of the controller",
      "sample_time_s");
}

/// Place of a mode's gains in the gains file: "gains.json:" or "gains.json:/modes/steering".
std::string place_of(const ModeGains& gains, std::optional<YawMode> mode, const std::string& file) {
  return file + ":" + (mode ? pointer_of(gains, *mode) : "");
}

/// Addition to the comment of a gain of one mode: ", in steering mode".
std::string of_mode(std::optional<YawMode> mode) {
  return mode ? fmt::format(", in {} mode", name_of(*mode)) : "";
}

/// Adds the friction widths w0 of the heading law (friction_widths.h): that of `mode`, or, without
/// `mode`, those of steering and combined mode.
void add_friction_widths(std::vector<Macro>& macros, const ModeGains& gains,
                         std::optional<YawMode> mode, const std::string& file) {
  for (const FrictionWidth& width : friction_widths(gains, mode)) {
    const HeadingGains<double>& heading = gains.in(width.mode).heading;
    const bool has_own_key = width.is_second && heading.combined_friction_width_radps > 0.0;
    macros.push_back(
        {fmt::format("AWMR_HEADING{}_FRICTION_WIDTH_RADPS{}", width.is_second ? "_COMBINED" : "",
                     mode ? mode_suffix(*mode) : ""),
         width.width_radps,
         fmt::format("{}{}rad/s: {}{}; gains", width.symbol, width.symbol.empty() ? "" : ", ",
                     width.meaning, of_mode(mode)),
         fmt::format("{}/heading/{}friction_width_radps", place_of(gains, width.mode, file),
                     has_own_key ? "combined_" : ""),
         MacroRange::kPositive});
  }
}

/// Adds the gains of both laws for one mode (`mode`), or for all modes without gains of their own.
void add_laws(std::vector<Macro>& macros, const ModeGains& gains, std::optional<YawMode> mode,
              const std::string& file) {
  const Gains<double>& set = mode ? gains.in(*mode) : gains.common();
  const std::string suffix = mode ? mode_suffix(*mode) : "";
  const auto add = [&](const char* name, double value, std::string_view comment,
                       std::string_view pointer) {
    macros.push_back({name + suffix, value, fmt::format("{}{}; gains", comment, of_mode(mode)),
                      place_of(gains, mode, file) + std::string(pointer), MacroRange::kPositive});
  };
  add("AWMR_HEADING_LAMBDA", set.heading.lambda,
      "lambda, 1/s: slope of the sliding surface S = e_dot + lambda e", "/heading/lambda");
  add("AWMR_HEADING_MU", set.heading.mu, "mu, rad/s^2: corrective yaw acceleration", "/heading/mu");
  add("AWMR_HEADING_EPSILON", set.heading.epsilon,
      "epsilon, rad/s: half width of the boundary layer of S", "/heading/epsilon");
  add_friction_widths(macros, gains, mode, file);
  add("AWMR_SPEED_MU", set.speed.mu, "mu_s, m/s^2: corrective surge acceleration", "/speed/mu");
  add("AWMR_SPEED_EPSILON", set.speed.epsilon,
      "epsilon_s, m/s: half width of the boundary layer of the speed error u_d - u",
      "/speed/epsilon");
}

/// Adds the observer of one mode (`mode`; all values are 0 if this mode has none). Without `mode`:
/// the observer of the modes without gains of their own, if there is one.
void add_observer(std::vector<Macro>& macros, const ModeGains& gains, std::optional<YawMode> mode,
                  const std::string& file) {
  const ObserverGains<double>& observer = mode ? gains.in(*mode).observer : gains.common().observer;
  if (mode ? !gains.has_observer() : !observer.is_on()) return;
  const auto add = [&](const char* name, double value, const char* comment, const char* pointer) {
    macros.push_back({name + (mode ? mode_suffix(*mode) : ""), value,
                      fmt::format("{}{}; gains", comment, of_mode(mode)),
                      place_of(gains, mode, file) + pointer,
                      mode ? MacroRange::kNotNegative : MacroRange::kPositive});
  };
  add("AWMR_OBSERVER_BANDWIDTH_RADPS", observer.bandwidth_radps,
      "L, rad/s: bandwidth of the disturbance observer", "/observer/bandwidth_radps");
  add("AWMR_OBSERVER_YAW_MAX_M", observer.yaw_max_m,
      "m: largest yaw moment that the observer compensates, divided by F_max",
      "/observer/yaw_max_m");
  add("AWMR_OBSERVER_SURGE_MAX", observer.surge_max,
      "1: largest surge force that the observer compensates, divided by F_max",
      "/observer/surge_max");
}

/// True if a float32 has full precision for the value: 0 and normal numbers. False for NaN.
bool is_zero_or_normal_float(double value) {
  using Limits = std::numeric_limits<float>;
  const double magnitude = std::abs(value);
  const bool is_zero = !(magnitude > 0.0) && !std::isnan(value);
  return is_zero || (magnitude >= static_cast<double>(Limits::min()) &&
                     magnitude <= static_cast<double>(Limits::max()));
}

}  // namespace

std::string file_name(const Model& model) {
  return std::filesystem::path(model.file).filename().string();
}

std::string mode_suffix(YawMode mode) {
  std::string suffix = fmt::format("_{}", name_of(mode));
  for (char& c : suffix) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return suffix;
}

std::vector<Macro> macros_of(const Model& model, const ModeGains& gains, const EmitInputs& inputs) {
  std::vector<Macro> macros;
  add_parameters(macros, model, file_name(model));
  add_vehicle(macros, model.vehicle, file_name(model));
  add_laws(macros, gains, std::nullopt, inputs.gains_file);
  add_observer(macros, gains, std::nullopt, inputs.gains_file);
  for (const YawMode mode : gains.listed_modes()) {
    add_laws(macros, gains, mode, inputs.gains_file);
    add_observer(macros, gains, mode, inputs.gains_file);
  }
  return macros;
}

Status check_macros(const std::vector<Macro>& macros) {
  std::vector<Fault> faults;
  for (const Macro& macro : macros) {
    if (!is_zero_or_normal_float(macro.value)) {
      faults.push_back({ErrorCode::kOutOfRange, macro.place,
                        fmt::format("{} = {:g} does not fit a 32-bit float, whose "
                                    "magnitudes go from 1.18e-38 to 3.40e+38; correct it",
                                    macro.name, macro.value)});
    } else if (macro.range == MacroRange::kPositive && macro.value <= 0.0) {
      faults.push_back({ErrorCode::kOutOfRange, macro.place,
                        fmt::format("{} = {:g} has to be above 0; correct it, or make this file "
                                    "again",
                                    macro.name, macro.value)});
    } else if (macro.range == MacroRange::kNotNegative && macro.value < 0.0) {
      faults.push_back({ErrorCode::kOutOfRange, macro.place,
                        fmt::format("{} = {:g} may not be below 0; correct it, or make this file "
                                    "again",
                                    macro.name, macro.value)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace awmr
