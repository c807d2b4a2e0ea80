#include "awmr/identify/coastdown/coast_alone.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/uncertainty/akaike.h"
#include "awmr/identify/uncertainty/diagnostics.h"
#include "awmr/model/ratio_names.h"

namespace awmr {
namespace {

/// Families that coast-downs can distinguish. The dead zone has no effect while the motors are off.
constexpr Family kCoastFamilies[] = {Family::kPower, Family::kCoulombLinear,
                                     Family::kCoulombLinearQuadratic, Family::kCoulombPower};

std::string name_of_ratio(TransformedParameter term) {
  return std::string(term == TransformedParameter::kCoulomb ? kCoulombOverSurgeName
                                                            : kQuadraticOverSurgeName);
}

EstimatorParameter linear(std::string name, double value, double variance, double half) {
  if (!(variance > 0.0)) return {std::move(name), value, {}, {}, {}};
  const double error = std::sqrt(variance);
  return {std::move(name), value, error, Interval{value - half * error, value + half * error}, {}};
}

EstimatorReport report_of_alone(const CoastFit& fit) {
  const double half = t_quantile_95(fit.dof);
  EstimatorReport report;
  report.subject = FitSubject::kMass;
  report.estimator = Estimator::kCurve;
  report.noise = "speed";
  report.parameters = {by_logarithm(std::string(kMassOverSurgeName), std::exp(fit.log_mass_norm),
                                    std::sqrt(fit.variance), half)};
  if (terms_of(fit.family).beta) {
    report.parameters.push_back(linear("surge.beta", fit.beta, fit.beta_variance, half));
  }
  for (const TermOverAlpha& term : fit.terms) {
    report.parameters.push_back(linear(name_of_ratio(term.term), term.value, term.variance, half));
  }
  report.family = name_of(fit.family);
  report.aicc = fit.aicc;
  add_curve_figures(report, fit);
  return report;
}

/// Fits the curves under the requested family, or under all kCoastFamilies if none or `auto` is
/// requested. The motors are off, so a dead zone has no effect.
std::vector<CoastFit> fits_of(const std::vector<CoastCurve>& curves, const Interval& beta_range,
                              const FamilyChoice& choice) {
  std::vector<CoastFit> fits;
  for (const Family family : kCoastFamilies) {
    if (choice.requested && family != without_dead_zone(choice.family.value_or(family))) continue;
    fits.push_back(fit_coast_alone(curves, beta_range, family));
  }
  return fits;
}

/// The usable fit with the smallest AICc; the first fit if none is usable.
const CoastFit& best_of(const std::vector<CoastFit>& fits) {
  return *std::min_element(fits.begin(), fits.end(), [](const CoastFit& a, const CoastFit& b) {
    if (!b.usable || !b.aicc) return a.usable && a.aicc.has_value();
    return a.usable && a.aicc && *a.aicc < *b.aicc;
  });
}

/// Text for a message: the ratios m'/a1, c1/a1, q1/a1 with standard errors, and the exponent b1.
std::string ratios_in_words(const CoastFit& fit) {
  const double ratio = std::exp(fit.log_mass_norm);
  std::string words =
      fmt::format("the ratio m'/a1 = {:.4g} +- {:.2g}", ratio, ratio * std::sqrt(fit.variance));
  for (const TermOverAlpha& term : fit.terms) {
    words += fmt::format(", {}/a1 = {:.4g} +- {:.2g}",
                         term.term == TransformedParameter::kCoulomb ? "c1" : "q1", term.value,
                         std::sqrt(term.variance));
  }
  if (terms_of(fit.family).beta) words += fmt::format(" and the exponent b1 = {:.4g}", fit.beta);
  return words;
}

/// Adds the finding `power-law-inadequate` if the AICc of another family is lower than that of the
/// power law by at least kFamilyAicThreshold.
void compare_with_other_families(const std::vector<CoastFit>& fits, const std::string& file,
                                 MassResult& result) {
  const CoastFit& power = fits.front();
  const CoastFit& best = best_of(fits);
  if (!power.aicc || !best.aicc || *power.aicc - *best.aicc < kFamilyAicThreshold) return;
  result.findings.push_back(
      {file, 0, Severity::kWarning, "power-law-inadequate",
       fmt::format("a power law does not describe these coast-downs: the AICc of {} is lower by {} "
                   "(residual standard deviation {:.3g}, power law {:.3g} m/s); use {}",
                   name_of(best.family), aic_decrease_text(*power.aicc - *best.aicc, 1),
                   best.residual_std_mps, power.residual_std_mps,
                   option_text(fmt::format("family {}", name_of(best.family))))});
}

}  // namespace

void add_curve_figures(EstimatorReport& report, const CoastFit& fit) {
  report.rows_used = fit.rows;
  report.residual_std = fit.residual_std_mps;
  report.degrees_of_freedom = static_cast<int>(fit.dof);
  report.rank = fit.rank;
  report.condition_number = fit.condition_number;
  report.stop_reason = fit.stop_reason;
  for (const std::vector<double>& run : fit.residuals) {
    if (const auto test = whiteness(run, 10)) report.diagnostics.push_back(*test);
    if (const auto test = normality(run)) report.diagnostics.push_back(*test);
  }
}

EstimatorParameter by_logarithm(std::string name, double value, double error, double half) {
  return {std::move(name),
          value,
          value * error,
          Interval{value * std::exp(-half * error), value * std::exp(half * error)},
          {}};
}

MassResult without_surge(const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         const FamilyChoice& family, MassResult result) {
  result.reason =
      "a coast-down gives mass_norm (m') only together with the surge resistance (a1, b1), "
      "which is not identified";
  if (curves.empty()) return result;
  const std::vector<CoastFit> fits = fits_of(curves, vehicle.surge_beta_range, family);
  const bool by_aicc = family.requested && !family.family;
  const CoastFit& fit = by_aicc ? best_of(fits) : fits.front();
  if (!fit.usable) {
    result.reason += fmt::format(" (the fit of the curve alone: {})", fit.stop_reason);
    return result;
  }
  result.reason =
      fmt::format("a coast-down curve determines only {}, not m' itself", ratios_in_words(fit));
  result.reports.push_back(report_of_alone(fit));
  for (const CoastFit& other : fits) {
    if (&other != &fit && other.usable) result.reports.push_back(report_of_alone(other));
  }
  if (!family.requested) compare_with_other_families(fits, curves.front().file, result);
  result.alone = fit;
  return result;
}

}  // namespace awmr
