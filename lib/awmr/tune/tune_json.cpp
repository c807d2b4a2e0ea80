#include "awmr/tune/tune_json.h"

#include "awmr/core/units.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "awmr/model/gains_json.h"
#include "awmr/model/model_json.h"
#include "awmr/model/vehicle_json.h"
#include "awmr/tune/option_table.h"

namespace awmr {
namespace {

/// Adds the quantiles of one set of gains in one mode to `json`, at /MODE/GAINS.
void put_quantiles(const EvaluatedGains& evaluated, Json& json) {
  Json& entry = json[std::string(name_of(evaluated.mode))][evaluated.gains];
  entry["completed_share"] = evaluated.completed_share;
  for (const EvaluatedFigure& figure : evaluated.figures) {
    entry[figure.name] = {
        {"median", figure.median}, {"q95", figure.q95}, {"tail_mean", figure.tail_mean}};
  }
}

Json worst_case_json(const char* name, const WorstCase& worst) {
  Json json;
  json[name] = number_or_null(worst.value);
  json["yaw_rate_degps"] = degrees(worst.yaw_rate_radps);
  json["parameters"] = Json::object();
  for (const auto& [id, value] : worst.parameters) json["parameters"][info(id).name] = value;
  return json;
}

Json rates_json(const Interval& rates_radps) {
  return {degrees(rates_radps.lo), degrees(rates_radps.hi)};
}

}  // namespace

void ReadOption::operator()(const char* key, double& value, const NumberRule& rule) const {
  value = json.optional_number(key, rule).value_or(value);
}
void ReadOption::operator()(const char* key, std::optional<double>& value,
                            const NumberRule& rule) const {
  value = json.optional_number(key, rule);
}
void ReadOption::operator()(const char* key, int& value, const NumberRule& rule) const {
  const auto min = static_cast<long>(rule.min);
  const auto max = static_cast<long>(rule.max);
  value = static_cast<int>(json.optional_integer(key, min, max).value_or(value));
}
void ReadOption::operator()(const char* key, Interval& value, const NumberRule& rule) const {
  value = json.optional_interval(key, rule).value_or(value);
}
void ReadOption::operator()(const char* key, std::optional<Interval>& value,
                            const NumberRule& rule) const {
  value = json.optional_interval(key, rule);
}

TuningLimits read_limits(JsonObject& json) {
  TuningLimits limits;
  limit_options(limits, ReadOption{json});
  return limits;
}

ExaminedRange read_examined(JsonObject& json) {
  return {.speed_mps = json.number("speed_mps", kNonNegative),
          .step_rad = radians(json.number("step_deg", kNonNegative)),
          .yaw_rate_radps = radians(json.number("yaw_rate_degps", kPositive))};
}

UnmodelledVariation read_open(JsonObject& json) {
  UnmodelledVariation open;
  if (json.has("mass_factors")) {
    open.mass_factors = json.numbers("mass_factors", kMassFactor);
    if (json.size("mass_factors") == 0) {
      json.fault(ErrorCode::kMissing, "mass_factors", "an empty list; leave the key out");
    }
  }
  if (json.has("wheel_forces")) {
    for (JsonObject& force : json.objects("wheel_forces")) {
      open.wheel_forces.push_back(wheel_force_from_json(std::move(force)));
    }
    if (json.size("wheel_forces") == 0) {
      json.fault(ErrorCode::kMissing, "wheel_forces", "an empty list; leave the key out");
    }
  }
  for (const auto& [key, count] : {std::pair("mass_factors", open.mass_factors.size()),
                                   std::pair("wheel_forces", open.wheel_forces.size())}) {
    if (count <= kMaxOpenValues) continue;
    json.fault(ErrorCode::kTooLarge, key,
               fmt::format("{} values are given, but at most {} are allowed; remove some", count,
                           kMaxOpenValues));
  }
  return open;
}

Json open_json(const UnmodelledVariation& open) {
  Json json = Json::object();
  if (!open.mass_factors.empty()) json["mass_factors"] = open.mass_factors;
  for (const Interval& force : open.wheel_forces) {
    json["wheel_forces"].push_back(wheel_force_to_json(force));
  }
  return json;
}

Json quantiles_json(const std::vector<EvaluatedGains>& evaluated) {
  Json json = Json::object();
  for (const EvaluatedGains& one : evaluated) put_quantiles(one, json);
  return json;
}

Json by_scenario_json(const std::vector<EvaluatedGains>& evaluated) {
  Json json = Json::object();
  for (const EvaluatedGains& one : evaluated) put_quantiles(one, json[one.scenario]);
  return json;
}

Json certificate_json(const Certificate& certificate) {
  const double margin_s = certificate.delay_margin_s();
  Json json = {
      {"set", certificate.parameters > 0 ? kCertifiedSet : kUncertifiedSet},
      {"damping_min", certificate.damping_min()},
      {"delay_margin_s", number_or_null(margin_s)},
      {"method",
       "heading loop inside the boundary layer, discretised exactly with hold, servo, latency and "
       "motor lag; smallest value over the ellipsoid of the parameters and the yaw rates, searched "
       "at the centre, axes, corners and 500 random points, then by a pattern search from the best "
       "point of each orthant"},
      {"parameters", certificate.parameters},
      {"degrees_of_freedom", certificate.degrees_of_freedom},
      {"yaw_rate_degps", rates_json(certificate.yaw_rate_radps())},
      {"latency_s", certificate.latency_s},
      {"motor_time_constant_s", certificate.motor_time_constant_s}};
  for (const ModeCertificate& one : certificate.modes) {
    json["modes"][std::string(name_of(one.mode))] = {
        {"yaw_rate_degps", rates_json(one.yaw_rate_radps)},
        {"damping", worst_case_json("min", one.damping)},
        {"delay_margin", worst_case_json("min_s", one.delay_margin_s)}};
  }
  return json;
}

Json trade_off_json(const TradeOff& trade_off) {
  const auto point_json = [](const TradeOffPoint& point) -> Json {
    return {{"settling_time_s", point.settling_time_s},
            {"control_variation", point.control_variation}};
  };
  Json json = {{"front", Json::array()}, {"gains", Json::object()}};
  for (const FrontPoint& one : trade_off.front) {
    json["front"].push_back(point_json(one.point));
    json["front"].back().update(gains_to_json(one.gains));
  }
  for (const NamedTradeOff& one : trade_off.named) json["gains"][one.gains] = point_json(one.point);
  return json;
}

Json goals_json(const std::vector<EvaluatedGoal>& goals) {
  Json json = Json::array();
  for (const EvaluatedGoal& evaluated : goals) {
    Json limits = Json::object();
    for (const GoalLimit& limit : evaluated.goal.at_most) limits[limit.figure] = limit.most;
    json.push_back({{"at_most", std::move(limits)},
                    {"share", evaluated.goal.share},
                    {"soft", evaluated.goal.is_soft},
                    {"mode", name_of(evaluated.mode)},
                    {"gains", evaluated.gains},
                    {"held", evaluated.held},
                    {"runs", evaluated.runs},
                    {"ci95", {evaluated.ci95.lo, evaluated.ci95.hi}},
                    {"verdict", name_in(kGoalVerdictNames, evaluated.verdict)}});
  }
  return json;
}

}  // namespace awmr
