#include "awmr/identify/admissible.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/assumed_sway.h"
#include "awmr/model/ranges.h"

namespace awmr {

void withdraw_uncertainty(Estimate& estimate) {
  estimate.std_error.reset();
  estimate.ci95.reset();
  estimate.quantiles.reset();
}

namespace {

void take_out(ParameterId id, std::string why, Model& model,
              std::map<ParameterId, std::string>& reasons) {
  Estimate& estimate = model[id];
  if (!estimate.value || estimate.source == Source::kGiven) return;
  estimate.value.reset();
  withdraw_uncertainty(estimate);
  reasons.emplace(id, std::move(why));
}

/// Reason why a model file cannot contain this value; empty if it can.
std::string refusal_reason(double value, const NumberRule& rule) {
  if (!std::isfinite(value)) return "the fitted value is not finite";
  if (allows(rule, value)) return {};
  return fmt::format("the fit gives {:.4g}, outside the allowed range [{:g}, {:g}]", value,
                     rule.min, rule.max);
}

/// Reason why the tables do not determine m' (mass over F_max): its 95 % interval is so wide
/// (kMaxOpen) that vehicles drawn from it cannot be simulated. Empty for any other parameter, and
/// for an m' from logs, because only a disagreement of several logs makes that interval so wide.
std::string why_open(ParameterId id, const Estimate& estimate) {
  constexpr double kMaxOpen = 1e4;  // largest accepted ratio of the upper end to the lower end
  const auto& ci = estimate.ci95;
  const bool is_of_logs = estimate.method == name_in(kEstimatorNames, Estimator::kTrajectory);
  if (id != ParameterId::kMassNorm || is_of_logs || !ci || !(ci->lo > 0.0)) return {};
  if (ci->hi <= kMaxOpen * ci->lo) return {};
  return fmt::format(
      "these trials give mass_norm a 95 % interval from {:.2g} to {:.2g}, whose ends differ by "
      "more than "
      "a factor of 10,000",
      ci->lo, ci->hi);
}

void remove_dependent_values(Model& model, std::map<ParameterId, std::string>& reasons) {
  const auto follow = [&](ParameterId first, ParameterId second) {
    if (!reasons.contains(first)) return;
    take_out(second, fmt::format("{} is not determined: {}", info(first).name, reasons.at(first)),
             model, reasons);
  };
  follow(ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta);
  follow(ParameterId::kSurgeBeta, ParameterId::kSurgeAlpha);
  follow(ParameterId::kYawAlpha, ParameterId::kYawBeta);
  follow(ParameterId::kYawBeta, ParameterId::kYawAlpha);
  follow(ParameterId::kSurgeAlpha, ParameterId::kMassNorm);
  follow(ParameterId::kMassNorm, ParameterId::kInertiaNorm);
  if (model[ParameterId::kSwayAlpha].method == kAssumedSwayMethod) {
    follow(ParameterId::kMassNorm, ParameterId::kSwayAlpha);
  }
  follow(ParameterId::kInertiaNorm, ParameterId::kMassNorm);
}

/// Covariance of the parameters that still have a value and a standard error.
Covariance kept(const Covariance& all, const Model& model) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < all.parameters.size(); ++i) {
    const Estimate& estimate = model[all.parameters[i]];
    const bool finite =
        std::ranges::all_of(all.matrix[i], [](double x) { return std::isfinite(x); });
    const bool positive = all.matrix[i][i] >= 0.0;
    if (estimate.value && estimate.std_error && finite && positive) places.push_back(i);
  }
  if (places.size() == all.parameters.size()) return all;
  Covariance rest;
  for (const std::size_t i : places) {
    rest.parameters.push_back(all.parameters[i]);
    std::vector<double>& row = rest.matrix.emplace_back();
    for (const std::size_t j : places) row.push_back(all.matrix[i][j]);
  }
  return rest;
}

}  // namespace

std::map<ParameterId, std::string> take_out_inadmissible(Model& model) {
  std::map<ParameterId, std::string> reasons;
  for (const ParameterInfo& parameter : parameter_table()) {
    Estimate& estimate = model[parameter.id];
    if (!estimate.value || estimate.source == Source::kGiven) continue;
    std::string why = refusal_reason(*estimate.value, rule_of(parameter.id));
    if (why.empty()) why = why_open(parameter.id, estimate);
    if (!why.empty()) take_out(parameter.id, std::move(why), model, reasons);
    const bool error = !estimate.std_error || std::isfinite(*estimate.std_error);
    const bool interval =
        !estimate.ci95 || (std::isfinite(estimate.ci95->lo) && std::isfinite(estimate.ci95->hi));
    if (error && interval) continue;
    withdraw_uncertainty(estimate);
    model.record.findings.push_back(
        {"", 0, Severity::kWarning, "no-interval",
         fmt::format("the standard error of {} is not finite, so the model has no interval for it; "
                     "record more runs",
                     parameter.name)});
  }
  remove_dependent_values(model, reasons);
  if (!model[ParameterId::kMassNorm].value) model.mass_norm_by_grip.reset();
  model.covariance = kept(model.covariance, model);
  return reasons;
}

}  // namespace awmr
