#include "awmr/core/json/json.h"
#include "awmr/core/statistics/drawn_rows.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

Json trial_json(const TrialResidual& trial) {
  return {{"kind", name_in(kTrialKindNames, trial.kind)},
          {"file", trial.file},
          {"line", trial.line},
          {"unit", trial.unit},
          {"measured", trial.measured},
          {"predicted", value_or_null(trial.predicted)},
          {"relative_error", value_or_null(trial.relative_error)}};
}

Json error_json(const PredictionError& error) {
  return {{"nrmse", error.nrmse}, {"r2", error.r2}, {"rmse", error.rmse}};
}

/// The series for a chart. Times are not rounded, because a long log needs more digits.
Json series_json(const PredictedSeries& series) {
  const auto numbers = [](const std::vector<double>& values) {
    Json list = Json::array();
    for (const double x : values) list.push_back(drawn_number(x));
    return list;
  };
  return {{"t_s", series.t_s},
          {"measured", numbers(series.measured)},
          {"predicted", numbers(series.predicted)}};
}

Json log_json(const LogValidation& log) {
  Json channels = Json::object();
  for (const ChannelValidation& channel : log.channels) {
    channels[channel.channel] = {{"unit", channel.unit},
                                 {"samples", channel.samples},
                                 {"one_step", error_json(channel.one_step)},
                                 {"long_horizon", error_json(channel.long_horizon)},
                                 {"series", series_json(channel.series)}};
  }
  return {{"file", log.file},
          {"horizon_s", log.horizon_s},
          {"passed", log.passed},
          {"channels", channels}};
}

Json estimate_json(const Estimate& estimate) {
  return {{"value", *estimate.value},
          {"std_error", *estimate.std_error},
          {"ci95", {estimate.ci95->lo, estimate.ci95->hi}}};
}

Json tyres_json(const TyreFit& tyres) {
  Json held_out = Json::object();
  for (const HeldOutError& error : tyres.held_out) {
    held_out[error.channel] = {{"model_rms", error.model_rms},
                               {"four_wheel_rms", error.four_wheel_rms}};
  }
  Json estimates = Json::object();
  if (tyres.friction) estimates["friction"] = estimate_json(*tyres.friction);
  if (tyres.cornering_per_rad) {
    estimates["cornering_stiffness_per_rad"] = estimate_json(*tyres.cornering_per_rad);
  }
  return {{"friction", tyres.tyres.friction},
          {"cornering_stiffness_per_rad", tyres.tyres.cornering_per_rad},
          {"estimates", estimates},
          {"windows", tyres.windows},
          {"held_out", held_out},
          {"better", tyres.better ? name_in(kPlantKindNames, *tyres.better) : kUndecidedPlant}};
}

Json drive_json(const Acceptance& drive) {
  Json channels = Json::object();
  for (const ChannelAcceptance& one : drive.channels) {
    channels[one.channel] = {{"unit", one.unit},
                             {"samples", one.samples},
                             {"noise", one.noise},
                             {"noise_from_log", one.noise_from_log},
                             {"distance", one.distance},
                             {"allowed", one.allowed},
                             {"inside", one.inside},
                             {"outside_since_s", value_or_null(one.outside_since_s)},
                             {"difference", one.difference}};
  }
  Json hypotheses = Json::array();
  for (const FaultHypothesis& one : drive.hypotheses) {
    hypotheses.push_back({{"what", one.what},
                          {"value", one.value},
                          {"unit", one.unit},
                          {"explained", one.explained}});
  }
  return {
      {"file", drive.file},       {"scenario", drive.scenario},     {"mode", name_of(drive.mode)},
      {"from_s", drive.from_s},   {"duration_s", drive.duration_s}, {"draws", drive.draws},
      {"p_value", drive.p_value}, {"inside", drive.inside},         {"channels", channels},
      {"suspects", hypotheses}};
}

const char* verdict_of(bool reproduced) { return reproduced ? "reproduced" : "not-reproduced"; }

Json case_json(const ClaimCase& open) {
  return {{"allocation", name_in(kAllocationFormNames, open.allocation)},
          {"wheel_force", {open.wheel_force.lo, open.wheel_force.hi}},
          {"mass_factor", open.mass_factor},
          {"split", name_in(kCombinedSplitNames, open.split)},
          {"verdict", verdict_of(open.reproduced)}};
}

Json cases_json(const Claim& claim) {
  Json json = Json::array();
  for (const ClaimCase& open : claim.cases) json.push_back(case_json(open));
  for (const ClaimInMode& one : claim.modes) {
    for (const ClaimCase& open : one.cases) {
      Json entry = case_json(open);
      entry["mode"] = name_of(one.mode);
      json.push_back(std::move(entry));
    }
  }
  return json;
}

Json claim_json(const Claim& claim) {
  Json json = {{"id", claim.id},
               {"statement", claim.statement},
               {"verdict", verdict_of(claim.reproduced)},
               {"figure", claim.figure},
               {"tolerance", claim.tolerance},
               {"why", claim.why}};
  for (const ClaimInMode& one : claim.modes) {
    json["modes"][std::string(name_of(one.mode))] = verdict_of(one.reproduced);
  }
  if (claim.cases.empty()) return json;
  json["cases"] = cases_json(claim);
  json["decided_by"] = claim.decided_by;
  return json;
}

}  // namespace

std::string validation_text(const Validation& validation, const Provenance& provenance) {
  Json json = output_document("awmr.validation/1", provenance);
  json["passed"] = validation.passed;
  json["verdict"] = validation.verdict;
  json["rms_relative_error"] = {
      {"surge", value_or_null(validation.surge_rms_relative_error)},
      {"turning", value_or_null(validation.turning_rms_relative_error)},
      {"coastdown", value_or_null(validation.coastdown_rms_relative_error)}};
  json["trials"] = Json::array();
  for (const TrialResidual& trial : validation.trials) json["trials"].push_back(trial_json(trial));
  json["logs"] = Json::array();
  for (const LogValidation& log : validation.logs) json["logs"].push_back(log_json(log));
  if (validation.tyres) json["tyres"] = tyres_json(*validation.tyres);
  if (!validation.drives.empty()) {
    json["drives"] = Json::array();
    for (const Acceptance& drive : validation.drives) json["drives"].push_back(drive_json(drive));
  }
  json["claims"] = Json::array();
  for (const Claim& claim : validation.claims) json["claims"].push_back(claim_json(claim));
  return to_text(json);
}

}  // namespace awmr
