#include "awmr/report/drawn_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "awmr/core/statistics/drawn_rows.h"
#include "awmr/model/fitted_law.h"

namespace awmr {
namespace {

/// Points of a curve, steps of a coast-down, and largest number of coast-downs in a chart.
constexpr int kCurvePoints = 120;
constexpr int kCoastSteps = 400;
constexpr std::size_t kMaxCoastdowns = 8;
/// 99 % of the values of a normal distribution are within this number of standard deviations.
constexpr double kWithin99 = 2.576;
/// Half width of a 95 % interval in standard errors, for a normal distribution.
constexpr double kNormalQuantile95 = 1.96;

/// Returns the number of standard errors in half of the exponent's 95 % interval, which the fit
/// took from Student's t; kNormalQuantile95 if the exponent has no interval.
double quantile_of_exponent(const Estimate& beta) {
  if (!beta.std_error || !(*beta.std_error > 0.0) || !beta.ci95) return kNormalQuantile95;
  return (beta.ci95->hi - beta.ci95->lo) / (2.0 * *beta.std_error);
}

/// Computes the curve from rest to 1.05 times the fastest run. The curve is steep at low rates, so
/// there are more points there.
void add_curve(const Model& model, TrialKind kind, DrawnFit& fit) {
  const auto law = fitted_law(model, kind);
  if (!law) return;
  fit.law = *law;
  if (kind == TrialKind::kSurge) {
    fit.law.coulomb += model.vehicle.driven_wheels() * *model[ParameterId::kWheelDeadZone].value;
  }
  double fastest = 0.0;
  for (const std::size_t i : fit.trials) {
    fastest = std::max(fastest, model.record.trials[i].measured);
  }
  const double quantile = quantile_of_exponent(model[law_parameters(kind).beta]);
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double share = static_cast<double>(i) / kCurvePoints;
    const double w = 1.05 * fastest * share * share;
    const double half = quantile * std::sqrt(variance_of_law(model, kind, std::array{w}));
    fit.curve.push_back({w, w > 0.0 ? fit.law.at(w) : fit.law.coulomb, half});
    fit.has_band = fit.has_band || half > 0.0;
  }
}

void add_left_over(const Model& model, DrawnFit& fit) {
  double squares = 0.0;
  for (const std::size_t i : fit.trials) {
    const TrialPoint& trial = model.record.trials[i];
    if (!trial.predicted || *trial.predicted == 0.0) continue;
    fit.left_over.push_back({i, 100.0 * (trial.measured / *trial.predicted - 1.0)});
    squares += fit.left_over.back().percent * fit.left_over.back().percent;
  }
  if (fit.left_over.size() < 3) return fit.left_over.clear();
  // n - 2 degrees of freedom, because alpha and beta were fitted to the n runs.
  fit.bound_percent =
      kWithin99 * std::sqrt(squares / static_cast<double>(fit.left_over.size() - 2));
}

/// Returns the initial speeds of the coast-downs, m/s, in ascending order, and for each speed the
/// longest stop time, s. If there are more than kMaxCoastdowns speeds, kMaxCoastdowns of them are
/// kept, evenly spaced in rank.
std::vector<std::pair<double, double>> coasts_of(const Model& model) {
  std::vector<std::pair<double, double>> coasts;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind == TrialKind::kCoastdown && trial.input > 0.0) {
      coasts.emplace_back(trial.input, std::max(trial.measured, trial.predicted.value_or(0.0)));
    }
  }
  // Of coast-downs with equal speed, the longest comes first, because unique() keeps the first one.
  std::sort(coasts.begin(), coasts.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  });
  coasts.erase(std::unique(coasts.begin(), coasts.end(),
                           [](const auto& a, const auto& b) { return a.first == b.first; }),
               coasts.end());
  if (coasts.size() <= kMaxCoastdowns) return coasts;
  std::vector<std::pair<double, double>> some;
  for (std::size_t i = 0; i < kMaxCoastdowns; ++i) {
    some.push_back(coasts[i * (coasts.size() - 1) / (kMaxCoastdowns - 1)]);
  }
  return some;
}

/// Integrates a coast-down by the midpoint rule. After the stop the speed stays 0.
CoastdownCurve coasted(const Resistance<double>& law, double mass_norm, double speed_mps,
                       double end_s) {
  CoastdownCurve curve{speed_mps, {0.0}, {speed_mps}};
  const double h = end_s / kCoastSteps;
  const auto rate = [&](double u) { return u > 0.0 ? -law.at(u) / mass_norm : 0.0; };
  double u = speed_mps;
  for (int i = 1; i <= kCoastSteps; ++i) {
    const double middle = std::max(0.0, u + 0.5 * h * rate(u));
    u = std::max(0.0, u + h * rate(middle));
    curve.t_s.push_back(i * h);
    curve.speed_mps.push_back(u);
  }
  return curve;
}

Json steady_json(const DrawnFit& fit) {
  Json json = {{"law",
                {{"constant", fit.law.coulomb},
                 {"alpha", fit.law.alpha},
                 {"beta", fit.law.beta},
                 {"quadratic", fit.law.quadratic}}},
               {"curve", Json::array()},
               {"has_band", fit.has_band},
               {"left_over", Json::array()},
               {"bound_percent", fit.bound_percent}};
  for (const CurvePoint& p : fit.curve) {
    json["curve"].push_back(
        {drawn_number(p.rate), drawn_number(p.value), drawn_number(p.half_band)});
  }
  for (const LeftOver& one : fit.left_over) json["left_over"].push_back({one.trial, one.percent});
  return json;
}

}  // namespace

std::optional<DrawnFit> drawn_fit(const Model& model, TrialKind kind) {
  DrawnFit fit;
  for (std::size_t i = 0; i < model.record.trials.size(); ++i) {
    if (model.record.trials[i].kind == kind) fit.trials.push_back(i);
  }
  if (fit.trials.empty()) return std::nullopt;
  add_curve(model, kind, fit);
  add_left_over(model, fit);
  return fit;
}

std::vector<CoastdownCurve> coastdown_curves(const Model& model) {
  const bool known = model[ParameterId::kSurgeAlpha].value && model[ParameterId::kSurgeBeta].value;
  const std::optional<double>& mass_norm = model[ParameterId::kMassNorm].value;
  std::vector<CoastdownCurve> curves;
  if (!known || !mass_norm) return curves;
  const Resistance<double> law = model.plant_as_known().surge;
  for (const auto& [speed_mps, stop_s] : coasts_of(model)) {
    curves.push_back(coasted(law, *mass_norm, speed_mps, 1.1 * stop_s));
  }
  return curves;
}

std::vector<bool> doubtful_trials(const Model& model) {
  std::set<std::pair<std::string, int>> rows;
  for (const Finding& finding : model.record.findings) {
    if (finding.severity != Severity::kNote) rows.emplace(finding.file, finding.line);
  }
  std::vector<bool> doubtful;
  for (const TrialPoint& trial : model.record.trials) {
    doubtful.push_back(rows.count({trial.file, trial.line}) > 0);
  }
  return doubtful;
}

Json fits_json(const Model& model) {
  Json json = Json::object();
  for (const TrialKind kind : {TrialKind::kSurge, TrialKind::kTurning}) {
    if (const auto fit = drawn_fit(model, kind)) {
      json[std::string(name_in(kTrialKindNames, kind))] = steady_json(*fit);
    }
  }
  Json curves = Json::array();
  for (const CoastdownCurve& curve : coastdown_curves(model)) {
    Json points = Json::array();
    for (std::size_t i = 0; i < curve.t_s.size(); ++i) {
      points.push_back({drawn_number(curve.t_s[i]), drawn_number(curve.speed_mps[i])});
    }
    curves.push_back({{"initial_speed_mps", curve.initial_speed_mps}, {"points", points}});
  }
  json["coastdown"] = std::move(curves);
  return json;
}

}  // namespace awmr
