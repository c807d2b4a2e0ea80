#include "awmr/model/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "awmr/core/file.h"
#include "awmr/core/input_file.h"
#include "awmr/core/json/json_document.h"
#include "awmr/core/option_text.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/ranges.h"
#include "awmr/model/si_units.h"
#include "awmr/model/transform.h"
#include "model_json.h"
#include "vehicle_json.h"

namespace awmr {
namespace {

constexpr std::string_view kModelSchema = "awmr.model/1";

/// Range of a parameter's quantiles: positive if the fit estimates the logarithm of the parameter
/// (transform.h). The quantiles of an exponent or of an optional term can be below 0.
NumberRule rule_of_quantile(ParameterId id) {
  return scale_of(id) == Scale::kLogarithmic ? kPositive : kAnyNumber;
}

Json estimate_to_json(const Estimate& estimate, std::string_view unit) {
  Json json;
  json["value"] = number_or_null(estimate.value);
  json["std_error"] = number_or_null(estimate.std_error);
  json["ci95"] = interval_or_null(estimate.ci95);
  json["unit"] = unit;
  json["source"] = name_in(kSourceNames, estimate.source);
  json["method"] = estimate.method;
  for (std::size_t q = 0; estimate.quantiles && q < kQuantileCount; ++q) {
    json["quantiles"][std::string(kQuantiles[q].key)] = (*estimate.quantiles)[q];
  }
  return json;
}

/// Reads the five quantiles, which must ascend and be within rule_of_quantile().
Quantiles quantiles_from_json(JsonObject& json, const ParameterInfo& parameter) {
  Quantiles quantiles{};
  for (std::size_t q = 0; q < kQuantileCount; ++q) {
    quantiles[q] = json.number(kQuantiles[q].key, rule_of_quantile(parameter.id));
    if (q == 0 || quantiles[q] >= quantiles[q - 1]) continue;
    json.fault(
        ErrorCode::kWrongOrder, kQuantiles[q].key,
        fmt::format("the quantile {:g} is below the quantile before it, {:g}; identify again",
                    quantiles[q], quantiles[q - 1]));
  }
  return quantiles;
}

Estimate estimate_from_json(JsonObject& json, const ParameterInfo& parameter) {
  Estimate estimate;
  estimate.value = json.nullable_number("value", rule_of(parameter.id));
  estimate.std_error = json.nullable_number("std_error", kNonNegative);
  estimate.ci95 = json.nullable_interval("ci95");
  const std::string unit[] = {std::string(parameter.unit)};
  json.choice("unit", unit);
  estimate.source = json.choice("source", kSourceNames);
  estimate.method = json.string("method");
  estimate.quantiles = json.optional_object(
      "quantiles", [&](JsonObject& object) { return quantiles_from_json(object, parameter); });
  return estimate;
}

/// Reads the estimate of every parameter. The pointer "/surge/alpha" is the key "alpha" in the
/// object "surge"; "/mass_norm" is a key at the root of the file.
void estimates_from_json(JsonObject& root, Model& model) {
  std::map<std::string, JsonObject, std::less<>> groups;
  for (const ParameterInfo& parameter : parameter_table()) {
    const std::string_view path = parameter.pointer.substr(1);
    const std::size_t slash = path.find('/');
    const auto read = [&](JsonObject& json) { return estimate_from_json(json, parameter); };
    if (parameter.term) {
      const std::string group(path.substr(0, slash));
      if (!groups.contains(group)) {
        const auto object = root.optional_object(group);
        if (!object) continue;
        groups.emplace(group, *object);
      }
      if (auto term = groups.at(group).optional_object(path.substr(slash + 1), read)) {
        model[parameter.id] = *std::move(term);
      }
      continue;
    }
    if (slash == std::string_view::npos) {
      model[parameter.id] = root.object(path, read);
      continue;
    }
    const std::string group(path.substr(0, slash));
    auto place = groups.find(group);
    if (place == groups.end()) place = groups.emplace(group, root.object(group)).first;
    model[parameter.id] = place->second.object(path.substr(slash + 1), read);
  }
  const auto family = [&groups](const std::string& group) {
    JsonObject& json = groups.at(group);
    return json.has("family") ? json.choice("family", kFamilyNames) : Family::kPower;
  };
  model.surge_family = family("surge");
  model.yaw_family = family("yaw");
  for (auto& [name, group] : groups) group.reject_unknown_keys();
}

void put_estimates(Json& json, const Model& model) {
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (is_absent_term(model, parameter.id)) continue;
    json[Json::json_pointer(std::string(parameter.pointer))] =
        estimate_to_json(estimate, parameter.unit);
  }
  if (model.surge_family != Family::kPower) json["surge"]["family"] = name_of(model.surge_family);
  if (model.yaw_family != Family::kPower) json["yaw"]["family"] = name_of(model.yaw_family);
}

/// Writes /si, the values in SI units, for the user. The reader ignores them, because they follow
/// from the rest of the file.
void put_si(Json& json, const Model& model) {
  for (const SiQuantity& quantity : si_quantities(model)) {
    json["si"][Json::json_pointer(quantity.pointer)] =
        estimate_to_json(quantity.estimate, quantity.unit);
  }
}

Json scrub_to_json(const YawScrub& scrub) {
  Json json{{"moment_m", scrub.moment_m},
            {"std_error_m", scrub.std_error_m},
            {"ci95_m", {scrub.ci95_m.lo, scrub.ci95_m.hi}},
            {"rows", scrub.rows},
            {"yaw_rate_radps", {scrub.yaw_rate_radps.lo, scrub.yaw_rate_radps.hi}}};
  if (scrub.changing_m) json["changing_m"] = {scrub.changing_m->lo, scrub.changing_m->hi};
  return json;
}

YawScrub scrub_from_json(JsonObject& json) {
  YawScrub scrub;
  scrub.moment_m = json.number("moment_m", {.min = -1e6, .max = 1e6});
  scrub.std_error_m = json.number("std_error_m", {.min = 0.0, .max = 1e6, .min_excluded = true});
  scrub.ci95_m = json.interval("ci95_m");
  scrub.rows = static_cast<int>(json.integer("rows", 3, 1'000'000'000L));
  scrub.yaw_rate_radps = json.interval("yaw_rate_radps");
  scrub.changing_m = json.optional_interval("changing_m");
  return scrub;
}

template <class Item, class ToJson>
Json list_to_json(const std::vector<Item>& items, ToJson to_json) {
  Json list = Json::array();
  for (const Item& item : items) list.push_back(to_json(item));
  return list;
}

}  // namespace

NumberRule rule_of(ParameterId id) {
  if (id == ParameterId::kWheelDeadZone) return kCommandDeadZone;
  if (info(id).term) return kTerm;
  if (id == ParameterId::kSteeringTimeConstant) return kServoTime_s;
  const bool is_exponent = id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
  return is_exponent ? kExponent : kCoefficient;
}

std::string model_text(const Model& model) {
  Json json = output_document(kModelSchema, model.record.provenance);
  json["vehicle"] = vehicle_to_json(model.vehicle);
  put_estimates(json, model);
  json["estimates"] = list_to_json(model.record.reports, report_to_json);
  json["covariance"] = covariance_to_json(model.covariance);
  if (model.mass_norm_by_grip) json["mass_norm_by_grip"] = *model.mass_norm_by_grip;
  if (model.yaw_scrub) json["yaw_scrub"] = scrub_to_json(*model.yaw_scrub);
  if (model.yaw_held_m) json["yaw_held_m"] = *model.yaw_held_m;
  if (model.yaw_by_sides_alone) json["yaw_by_sides_alone"] = true;
  if (const auto& rate_radps = model.record.logged_yaw_rate_radps) {
    json["logged_yaw_rate_radps"] = *rate_radps;
  }
  put_si(json, model);
  json["findings"] = findings_to_json(model.record.findings);
  json["trials"] = list_to_json(model.record.trials, trial_to_json);
  return to_text(json);
}

namespace {

Model model_from_json(JsonObject& root) {
  Model model;
  root.schema(kModelSchema);
  model.record.provenance = read_provenance(root);
  JsonObject vehicle = root.object("vehicle");
  model.vehicle = vehicle_from_json(vehicle);
  estimates_from_json(root, model);
  model.record.reports = root.objects("estimates", report_from_json);
  model.covariance = root.object("covariance", covariance_from_json);
  model.mass_norm_by_grip = root.optional_number("mass_norm_by_grip", kCoefficient);
  model.yaw_scrub = root.optional_object("yaw_scrub", scrub_from_json);
  constexpr NumberRule kAMoment{.min = 0.0, .max = 1e6, .min_excluded = true};
  constexpr NumberRule kARate{.min = 0.0, .max = 1e3, .min_excluded = true};
  model.yaw_held_m = root.optional_number("yaw_held_m", kAMoment);
  model.yaw_by_sides_alone = root.optional_boolean("yaw_by_sides_alone").value_or(false);
  model.record.logged_yaw_rate_radps = root.optional_number("logged_yaw_rate_radps", kARate);
  root.optional_object("si");
  model.record.findings = root.objects("findings", finding_from_json);
  model.record.trials = root.objects("trials", trial_from_json);
  root.reject_unknown_keys();
  return model;
}

}  // namespace

namespace {

/// Adds a fault for each contradiction between a measured scrub moment, its interval and the
/// vehicle.
void add_scrub_contradictions(const YawScrub& scrub, const Model& model,
                              std::vector<Fault>& faults) {
  const std::string place = model.file + ":/yaw_scrub";
  const auto check = [&](bool is_so, const char* key, const std::string& why) {
    if (!is_so) {
      faults.push_back({ErrorCode::kContradiction, fmt::format("{}/{}", place, key), why});
    }
  };
  const Interval ci = scrub.ci95_m;
  check(ci.contains(scrub.moment_m), "ci95_m",
        fmt::format("the interval [{:g}, {:g}] does not contain moment_m {:g}; identify again",
                    ci.lo, ci.hi, scrub.moment_m));
  check(ci.hi >= 0.0, "ci95_m",
        fmt::format("the interval [{:g}, {:g}] is below 0, but tyre scrub always resists a turn; "
                    "identify again",
                    ci.lo, ci.hi));
  // The half width of a 95 % interval, divided by the standard error, is a quantile of Student's t:
  // 12.7 with one degree of freedom, 1.96 with many.
  const double quantile = 0.5 * (ci.hi - ci.lo) / scrub.std_error_m;
  check(quantile >= 1.95 && quantile <= 12.8, "std_error_m",
        fmt::format("the standard error {:g} does not match ci95_m [{:g}, {:g}]: the half width of "
                    "the interval is {:.3g} standard errors, where 1.96 to 12.7 are possible; "
                    "identify again",
                    scrub.std_error_m, ci.lo, ci.hi, quantile));
  check(std::abs(0.5 * (ci.lo + ci.hi) - scrub.moment_m) <= 0.01 * (ci.hi - ci.lo), "moment_m",
        fmt::format("the moment {:g} is not the middle of ci95_m [{:g}, {:g}]; identify again",
                    scrub.moment_m, ci.lo, ci.hi));
  check(scrub.yaw_rate_radps.lo > 0.0 && scrub.yaw_rate_radps.hi < 1e3, "yaw_rate_radps",
        "yaw rates must be above 0 and below 1000 rad/s; identify again");
  // The moment was measured, so the wheel forces overcame it: it cannot exceed their largest yaw
  // moment.
  const Interval force = model.vehicle.wheel_force;
  const double most_m = differential_moment_m(model.vehicle.half_track_m, force.hi - force.lo);
  check(scrub.moment_m <= most_m, "moment_m",
        fmt::format("the measured scrub moment, {:g} m (divided by F_max), exceeds the largest yaw "
                    "moment that different left and right wheel forces can make, {:.4g} m "
                    "(from wheel_force and half_track_m under /vehicle of this file). Correct the "
                    "forces in the differential turns of the turning table, or wheel_force and "
                    "half_track_m in vehicle.json, and run awmr identify again",
                    scrub.moment_m, most_m));
}

/// Adds a fault for each contradiction between the identified quantities and the vehicle: a value
/// of I'z/m' that is impossible for any distribution of the mass; a dead zone beyond the largest
/// wheel force.
void add_vehicle_contradictions(const Model& model, std::vector<Fault>& faults) {
  const Estimate& inertia = model[ParameterId::kInertiaNorm];
  const Estimate& mass = model[ParameterId::kMassNorm];
  if (inertia.value && mass.value && implausible_values(model.vehicle).empty()) {
    const Interval range = inertia_over_vehicle(model.vehicle, inertia, mass);
    if (!(range.hi > kInertiaOverBox.lo && range.lo < kInertiaOverBox.hi)) {
      faults.push_back(
          {ErrorCode::kContradiction, model.file + ":/inertia_norm/value",
           fmt::format("the ratio of yaw inertia to mass, I'z/m', is {:.3g} times Iz/m of "
                       "/vehicle, where {:g} to {:g} times is possible; identify again",
                       inertia_over_vehicle(model.vehicle, *inertia.value, *mass.value),
                       kInertiaOverBox.lo, kInertiaOverBox.hi)});
    }
  }
  const double zone = model[ParameterId::kWheelDeadZone].value.value_or(0.0);
  if (zone < model.vehicle.wheel_force.hi) return;
  faults.push_back({ErrorCode::kContradiction, model.file + ":/wheel/dead_zone/value",
                    fmt::format("with a dead zone of {:g}, the wheels make no force, because "
                                "/vehicle/wheel_force/max is {:g}; identify again",
                                zone, model.vehicle.wheel_force.hi)});
}

/// True if the user accepted the vehicle's implausible values: only `identify --as-is` adds this
/// finding.
bool accepts_implausible(const Model& model) {
  return std::ranges::any_of(model.record.findings, [](const Finding& finding) {
    return finding.code == "implausible-vehicle";
  });
}

/// Finds contradictions, as a file that was edited by hand can have: a value outside its interval,
/// a scrub moment that does not fit its interval, a standard error that differs from the
/// covariance.
std::vector<Fault> self_contradictions(const Model& model) {
  constexpr double kTolerance = 0.01;
  std::vector<Fault> faults;
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (!estimate.value || !estimate.ci95 || estimate.ci95->contains(*estimate.value)) continue;
    faults.push_back(
        {ErrorCode::kContradiction, fmt::format("{}:{}/ci95", model.file, parameter.pointer),
         fmt::format(
             "the interval [{:g}, {:g}] does not contain the value {:g}; identify again, or "
             "write null for no interval",
             estimate.ci95->lo, estimate.ci95->hi, *estimate.value)});
  }
  add_vehicle_contradictions(model, faults);
  if (model.yaw_scrub) add_scrub_contradictions(*model.yaw_scrub, model, faults);
  const Covariance& covariance = model.covariance;
  for (std::size_t i = 0; i < covariance.parameters.size(); ++i) {
    const ParameterInfo& parameter = info(covariance.parameters[i]);
    const std::optional<double>& std_error = model[parameter.id].std_error;
    const double variance = covariance.matrix[i][i];
    if (!std_error || std::abs(std::sqrt(variance) - *std_error) <= kTolerance * *std_error) {
      continue;
    }
    faults.push_back({ErrorCode::kContradiction, model.file + ":/covariance",
                      fmt::format("the variance of {} is {:g}, which is not the square of its "
                                  "std_error {:g}; identify again",
                                  parameter.name, variance, *std_error)});
  }
  return faults;
}

/// Parses a model. `as_is`: accepts a vehicle with implausible values.
Result<Model> parse_model(std::string_view text, const std::string& file, bool as_is) {
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_text(text, file));
  std::vector<Fault> faults;
  JsonObject root(json, file, "", faults);
  Model model = model_from_json(root);
  model.file = file;
  if (!faults.empty() && json.is_object() && json.contains("vehicle")) {
    explain_vehicle_faults(json.at("vehicle"), file + ":/vehicle", faults);
    explain_missing_estimates(file, model.vehicle, faults);
  }
  if (faults.empty()) faults = self_contradictions(model);
  if (!faults.empty()) return input_errors(std::move(faults));
  if (!as_is && !accepts_implausible(model)) {
    AWMR_RETURN_IF_ERROR(check_plausible(model.vehicle, file + ":/vehicle",
                                         "Correct vehicle.json and identify again, with " +
                                             option_text("as-is") + " if the value is right"));
  }
  return model;
}

}  // namespace

Result<Model> read_model(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_input(path, kMaxJsonBytes));
  return parse_model(text, path.string(), false);
}

Result<Model> read_model_as_is(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_input(path, kMaxJsonBytes));
  return parse_model(text, path.string(), true);
}

Result<Model> model_from_text(std::string_view text, const std::string& file) {
  return parse_model(text, file, false);
}

Status check_model_text(std::string_view text, const std::string& file) {
  AWMR_RETURN_IF_ERROR(model_from_text(text, file));
  return {};
}

std::string model_schema() {
  return json_schema_text(kModelSchema, "A model: a vehicle's parameters with their uncertainty",
                          [](JsonObject& json) { model_from_json(json); });
}

Status write_model(const Model& model, const std::filesystem::path& path) {
  return write_file(path, model_text(model), check_model_text);
}

}  // namespace awmr
