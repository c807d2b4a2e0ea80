#include "awmr/identify/refusals.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "awmr/identify/assumed_sway.h"
#include "awmr/identify/logs/log_setup.h"

namespace awmr {
namespace {

bool has_coastdown(const TrialData& data) {
  return (data.coastdown && !data.coastdown->rows.empty()) || !data.curves.empty();
}

bool is_assumed(const Estimate& estimate) { return estimate.method == kAssumedSwayMethod; }

bool is_surge_law(ParameterId id) {
  return id == ParameterId::kSurgeAlpha || id == ParameterId::kSurgeBeta;
}

bool is_yaw_law(ParameterId id) {
  return id == ParameterId::kYawAlpha || id == ParameterId::kYawBeta;
}

bool is_inertial(ParameterId id) {
  return id == ParameterId::kMassNorm || id == ParameterId::kInertiaNorm;
}

/// Reason why the tables do not determine a parameter. Tables never determine the sway resistance,
/// the servo's time constant and back-EMF; the reason is then that vehicle.json has no value.
std::string table_reason(ParameterId id, const TrialData& data, const Reasons& reasons) {
  switch (id) {
    case ParameterId::kSurgeAlpha:
    case ParameterId::kSurgeBeta:
      if (!data.surge) return reasons.curve_alone ? reasons.mass : "there is no surge trial";
      if (!reasons.surge.empty()) return reasons.surge;
      return fmt::format(
          "the usable surge rows ({}) do not contain two different thrusts (tau_speed) with "
          "different speeds",
          data.surge->rows.size());
    case ParameterId::kYawAlpha:
    case ParameterId::kYawBeta:
      if (!data.turning) return "there is no turning trial";
      if (!reasons.turning.empty()) return reasons.turning;
      return fmt::format(
          "the usable turning rows ({}) do not contain two different yaw moments (tau_turn) with "
          "different yaw rates",
          data.turning->rows.size());
    case ParameterId::kMassNorm:
    case ParameterId::kInertiaNorm:
      return has_coastdown(data) ? reasons.mass : "there is no coast-down trial";
    case ParameterId::kSwayAlpha:
      return "sway_alpha is not in vehicle.json";
    default:
      return "vehicle.json does not give it";
  }
}

/// The trial or channel that would identify the parameter.
std::string_view remedy_of(ParameterId id, const TrialData& data, const Vehicle& vehicle) {
  const bool is_turning = is_yaw_law(id) || id == ParameterId::kInertiaNorm;
  const bool is_surge = is_surge_law(id) || id == ParameterId::kMassNorm;
  using enum LogChannel;
  if (!data.logs.empty() && is_surge && !is_logged(data.logs, {kSpeed, kX})) {
    return "logs with speed_mps, or with both x_m and y_m, which these logs lack (or map columns "
           "to these names)";
  }
  if (!data.logs.empty() && is_turning && !is_logged(data.logs, {kYawRate, kHeading, kX})) {
    return "logs with yaw_rate_radps or heading_deg, which these logs lack (or map columns to "
           "these names)";
  }
  return trial_of(vehicle, id);
}

bool is_steered(const DrivingLog& log) {
  return std::ranges::any_of(log.driving_steering_rad(),
                             [](double angle_rad) { return angle_rad != 0.0; });
}

/// True if a log has the channels and commands that measure the parameter.
bool is_shown(ParameterId id, const DrivingLog& log) {
  using enum LogChannel;
  const bool has_turns = log[kYawRate] || log[kHeading] || log[kX];
  switch (id) {
    case ParameterId::kYawAlpha:
    case ParameterId::kYawBeta:
    case ParameterId::kInertiaNorm:
      return has_turns && (is_steered(log) || has_force_difference(log));
    case ParameterId::kSteeringTimeConstant:
      return has_turns && has_steering_changes(log);
    case ParameterId::kSwayAlpha:
      return false;  // few logs determine it, and without it a value is assumed
    default:
      return true;
  }
}

/// True if it is an error that the data do not identify `id`: the user named the parameter, a table
/// should measure it, or a log should measure it and it has no other value.
bool is_required(ParameterId id, const TrialData& data, const IdentifyOptions& options,
                 const Estimate& estimate) {
  if (!options.requested.empty()) return true;
  const bool by_table = (data.surge && is_surge_law(id)) || (data.turning && is_yaw_law(id)) ||
                        (has_coastdown(data) && is_inertial(id));
  const bool by_log =
      std::ranges::any_of(data.logs, [&](const DrivingLog& log) { return is_shown(id, log); });
  return by_table || (!estimate.value && by_log);
}

}  // namespace

std::vector<ParameterId> requested_parameters(const Vehicle& vehicle, const TrialData& data,
                                              const IdentifyOptions& options) {
  if (!options.requested.empty()) {
    std::vector<ParameterId> requested = options.requested;
    std::erase_if(requested, [&](ParameterId id) { return !has(vehicle, id); });
    return requested;
  }
  std::vector<ParameterId> ids;
  if (data.surge) ids.insert(ids.end(), {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta});
  if (data.turning) ids.insert(ids.end(), {ParameterId::kYawAlpha, ParameterId::kYawBeta});
  if (data.coastdown || !data.curves.empty()) {
    ids.insert(ids.end(), {ParameterId::kMassNorm, ParameterId::kInertiaNorm});
  }
  if (!data.logs.empty()) {
    for (const ParameterInfo& parameter : parameter_table()) {
      if (!parameter.term && has(vehicle, parameter.id)) ids.push_back(parameter.id);
    }
  }
  return ids;
}

std::vector<ParameterId> refuse_what_is_missing(const TrialData& data, const Reasons& reasons,
                                                const std::vector<ParameterId>& requested,
                                                const IdentifyOptions& options, Model& model) {
  std::vector<ParameterId> refused;
  for (const ParameterInfo& parameter : parameter_table()) {
    Estimate& estimate = model[parameter.id];
    if (!has(model.vehicle, parameter.id)) {
      estimate = {{}, {}, {}, Source::kGiven, "no steering"};
      continue;
    }
    const bool wanted =
        std::find(requested.begin(), requested.end(), parameter.id) != requested.end();
    const auto logged = reasons.logs.find(parameter.id);
    const bool held = estimate.value && logged != reasons.logs.end() && wanted &&
                      (estimate.source == Source::kGiven || is_assumed(estimate));
    if (estimate.value && !held) continue;
    if (!estimate.value) {
      estimate.source = Source::kFitted;
      estimate.method = "none";
    }
    const bool required = wanted && is_required(parameter.id, data, options, estimate);
    if (required) refused.push_back(parameter.id);
    const auto inadmissible = reasons.inadmissible.find(parameter.id);
    const std::string why = inadmissible != reasons.inadmissible.end() ? inadmissible->second
                            : logged != reasons.logs.end()
                                ? logged->second
                                : table_reason(parameter.id, data, reasons);
    const std::string kept =
        held ? fmt::format(" (the {} value {:.4g} is kept)",
                           is_assumed(estimate) ? "assumed" : "given", *estimate.value)
             : std::string();
    model.record.findings.push_back(
        {"", 0, required ? Severity::kError : Severity::kNote, "not-identifiable",
         fmt::format("{} ({}) cannot be identified: {}; record {}{}", parameter.name,
                     parameter.meaning, why, remedy_of(parameter.id, data, model.vehicle), kept)});
  }
  return refused;
}

}  // namespace awmr
