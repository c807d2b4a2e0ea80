/// Model and gains of the paper's robot, written by hand in the form that identify and tune give.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/emit/emit.h"
#include "awmr/model/gains_file.h"
#include "support/paper_vehicle.h"
#include "support/process.h"

namespace awmr::testing {

inline Model paper_robot() {
  Model model;
  model.vehicle = paper_vehicle();
  const auto fitted = [](double value, double std_error) {
    return Estimate{.value = value,
                    .std_error = std_error,
                    .ci95 = Interval{value - 2.0 * std_error, value + 2.0 * std_error},
                    .source = Source::kFitted,
                    .method = "log-linear"};
  };
  // Values of the paper's Appendix B, with the standard errors of log-linear fits of its tables.
  model[ParameterId::kSurgeAlpha] = fitted(1.3268, 0.0183);
  model[ParameterId::kSurgeBeta] = fitted(0.8933, 0.0156);
  model[ParameterId::kYawAlpha] = fitted(0.3028, 0.0042);
  model[ParameterId::kYawBeta] = fitted(0.8250, 0.012);
  model[ParameterId::kSwayAlpha] = {3.0, {}, {}, Source::kGiven, "vehicle.json"};
  model[ParameterId::kMassNorm] = {0.0768, 0.0108, {}, Source::kDerived, "stop time"};
  model[ParameterId::kInertiaNorm] = {0.0128, {}, {}, Source::kDerived, "box formula"};
  model[ParameterId::kSteeringTimeConstant] = {0.02, {}, {}, Source::kGiven, "vehicle.json"};
  return model;
}

inline EmitInputs paper_inputs() {
  return {.model_sha256 = std::string(64, 'a'),
          .gains_sha256 = std::string(64, 'b'),
          .gains_file = "gains.json"};
}

/// Writes the emitted library of this robot as files.
inline void write_library(const std::filesystem::path& directory, const EmitOptions& options = {}) {
  const auto files = firmware_library(paper_robot(), kPaperGains, paper_inputs(), options);
  for (const EmittedFile& file : files.value()) {
    std::filesystem::create_directories((directory / file.path).parent_path());
    write_all(directory / file.path, file.bytes);
  }
}

/// The documented macros with their expected values, by name.
inline std::vector<std::pair<std::string, double>> expected_macros(const Model& model,
                                                                   const Gains<double>& gains) {
  const auto value = [&model](ParameterId id) { return model[id].value.value(); };
  const Vehicle& vehicle = model.vehicle;
  return {{"AWMR_SURGE_ALPHA", value(ParameterId::kSurgeAlpha)},
          {"AWMR_SURGE_BETA", value(ParameterId::kSurgeBeta)},
          {"AWMR_YAW_ALPHA", value(ParameterId::kYawAlpha)},
          {"AWMR_YAW_BETA", value(ParameterId::kYawBeta)},
          {"AWMR_SWAY_ALPHA", value(ParameterId::kSwayAlpha)},
          {"AWMR_MASS_NORM", value(ParameterId::kMassNorm)},
          {"AWMR_INERTIA_NORM", value(ParameterId::kInertiaNorm)},
          {"AWMR_FRONT_AXLE_M", vehicle.front_axle_m},
          {"AWMR_HALF_TRACK_M", vehicle.half_track_m},
          {"AWMR_WHEEL_FORCE_MIN", vehicle.wheel_force.lo},
          {"AWMR_WHEEL_FORCE_MAX", vehicle.wheel_force.hi},
          {"AWMR_STEERING_MAX_RAD", radians(vehicle.steering_max_deg)},
          {"AWMR_SAMPLE_TIME_S", vehicle.sample_time_s},
          {"AWMR_HEADING_LAMBDA", gains.heading.lambda},
          {"AWMR_HEADING_MU", gains.heading.mu},
          {"AWMR_HEADING_EPSILON", gains.heading.epsilon},
          {"AWMR_SPEED_MU", gains.speed.mu},
          {"AWMR_SPEED_EPSILON", gains.speed.epsilon}};
}

/// Returns the text after `#define NAME ` in a header; empty if it does not define NAME.
inline std::string macro_text(const std::string& header, const std::string& name) {
  const std::string start = "\n#define " + name + " ";
  const std::size_t at = header.find(start);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + start.size();
  return header.substr(begin, header.find('\n', begin) - begin);
}

/// The header with the value of one macro replaced, as a user might edit it by hand.
inline std::string with_macro(std::string header, const std::string& name,
                              const std::string& literal) {
  const std::string old_line = "\n#define " + name + " " + macro_text(header, name) + "\n";
  return header.replace(header.find(old_line), old_line.size(),
                        "\n#define " + name + " " + literal + "\n");
}

}  // namespace awmr::testing
