#include "awmr/identify/coastdown/mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "awmr/core/index.h"
#include "awmr/identify/coastdown/coast_alone.h"
#include "awmr/identify/uncertainty/quantiles.h"

namespace awmr {
namespace {

/// A curve whose speed falls by less than this many deviations of its noise shows no deceleration.
constexpr double kMinimumFall = 5.0;

/// The noise of a curve, by how far each speed lies off the line through its neighbours:
///
///     e_i = u_i - (1 - w) u_(i-1) - w u_(i+1),   w = (t_i - t_(i-1))/(t_(i+1) - t_(i-1))
///     std^2 = mean of e_i^2/(1 + w^2 + (1 - w)^2)
double noise_of(const CoastCurve& curve) {
  const std::vector<double>& t = curve.t_s;
  const std::vector<double>& u = curve.speed_mps;
  double squares = 0.0;
  for (std::size_t i = 1; i + 1 < u.size(); ++i) {
    const double w = (t[i] - t[i - 1]) / (t[i + 1] - t[i - 1]);
    const double e = u[i] - (1.0 - w) * u[i - 1] - w * u[i + 1];
    squares += e * e / (1.0 + w * w + (1.0 - w) * (1.0 - w));
  }
  return std::sqrt(squares / static_cast<double>(u.size() - 2));
}

/// False for a curve whose speeds only wander about one level: its mean of the last fifth is not
/// below that of the first by more than noise explains. Precondition: three rows.
bool falls(const CoastCurve& curve) {
  const std::size_t part = std::max<std::size_t>(1, curve.speed_mps.size() / 5);
  const auto mean = [&](std::size_t begin) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + part; ++i) sum += curve.speed_mps[i];
    return sum / static_cast<double>(part);
  };
  const double fall = mean(0) - mean(curve.speed_mps.size() - part);
  return fall > kMinimumFall * noise_of(curve) / std::sqrt(static_cast<double>(part)) && fall > 0.0;
}

/// Returns the curves that fall, and adds a finding to `result` for each of the others.
std::vector<CoastCurve> falling(const std::vector<CoastCurve>& curves, MassResult& result) {
  std::vector<CoastCurve> kept;
  for (const CoastCurve& curve : curves) {
    if (falls(curve)) {
      kept.push_back(curve);
      continue;
    }
    result.findings.push_back(
        {curve.file, curve.line, Severity::kWarning, "no-deceleration",
         "the speed of this coast-down does not fall by more than its noise: it shows nothing of "
         "m' and is set aside"});
  }
  return kept;
}

/// m' from the stop times, whose report goes into `result`. Where they give none, `result` has the
/// reason.
std::optional<MassEstimate> by_stop_time(const SteadyFit& surge,
                                         const std::optional<TrialSet<StopTimeRow>>& stops,
                                         MassResult& result) {
  if (!stops || stops->rows.empty()) return std::nullopt;
  const auto mass = mass_from_stop_time(surge, stops->rows);
  if (!mass) {
    result.reason = fmt::format(
        "the surge exponent {:.4g} is 1 or more: with it the vehicle never stops, and a stop time "
        "says nothing",
        surge[TransformedParameter::kBeta]);
    return std::nullopt;
  }
  const MassEstimate estimate = from_stop_time(*mass, stops->rows.size());
  result.reports.push_back(report_of(estimate, surge, Estimator::kStopTime, "time"));
  result.reports.back().rows_used = static_cast<int>(stops->rows.size());
  return estimate;
}

/// m' from the curves, whose report goes into `result`. Where they give none, `result` has the
/// reason.
std::optional<MassEstimate> by_curves(const SteadyFit& surge, const std::vector<CoastCurve>& curves,
                                      MassResult& result) {
  if (curves.empty()) {
    if (result.reason.empty()) result.reason = "no coast-down shows a deceleration";
    return std::nullopt;
  }
  const CoastFit fit = fit_coast(curves, surge);
  const std::string& file = curves.front().file;
  if (!fit.usable) {
    result.reason = "the fit of the coast-down curve failed: " + fit.stop_reason;
    result.findings.push_back({file, 0, Severity::kWarning, "not-converged", result.reason});
    return std::nullopt;
  }
  const MassEstimate estimate = from_curve(fit);
  result.reports.push_back(report_of(estimate, surge, Estimator::kCurve, "speed"));
  add_curve_figures(result.reports.back(), fit);
  if (fit.autocorrelated) {
    result.findings.push_back(
        {file, 0, Severity::kNote, "coloured-residuals",
         "neighbouring residuals of the coast-down are correlated; the interval of mass_norm "
         "allows for it"});
  }
  return estimate;
}

EstimatorReport report_of(const JointFit& joint, std::size_t surge_rows) {
  EstimatorReport report;
  report.subject = FitSubject::kMass;
  report.estimator = Estimator::kJoint;
  report.noise = "as the surge fit, and speed";
  const Subject surge{};  // the ids of surge
  for (std::size_t i = 0; i < joint.surge.free.size(); ++i) {
    const Eigen::Index row = eigen_index(i);
    const TransformedParameter c = joint.surge.free[i];
    const double error = std::sqrt(joint.covariance(row, row));
    const double half = t_quantile_95(joint.dof(row)) * error;
    const double x = joint.surge[c];
    report.parameters.push_back({std::string(info(parameter_of(surge, c)).name),
                                 value_from(c, x),
                                 jacobian_of(c, x) * error,
                                 values_from(c, {x - half, x + half}),
                                 {}});
  }
  const Eigen::Index last = joint.covariance.rows() - 1;
  report.parameters.push_back(by_logarithm("mass_norm", std::exp(joint.log_mass_norm),
                                           std::sqrt(joint.covariance(last, last)),
                                           t_quantile_95(joint.dof(last))));
  report.rows_used = joint.coast.rows + static_cast<int>(surge_rows);
  report.residual_std = joint.coast.residual_std_mps;
  report.rank = static_cast<int>(joint.covariance.rows());
  report.condition_number = 0.0;
  report.stop_reason = joint.coast.stop_reason;
  return report;
}

/// `implausible-deceleration` and the like. A whole curve does not hang on the last centimetres.
void check(const SteadyFit& surge, const std::optional<TrialSet<StopTimeRow>>& stops,
           bool has_curves, const Vehicle& vehicle, MassResult& result) {
  if (!result.estimate || !stops) return;
  const auto variance = result.estimate->variance(surge);
  std::optional<double> deviation;
  if (variance && !has_curves) deviation = std::sqrt(*variance);
  check_mass(surge.law(), *stops, vehicle.mass_kg, std::exp(result.estimate->log_mass_norm),
             deviation, result.findings);
}

}  // namespace

MassResult estimate_mass(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                         const std::vector<CoastCurve>& all_curves, const Vehicle& vehicle,
                         const FamilyChoice& family, bool joint) {
  MassResult result;
  const std::vector<CoastCurve> curves = falling(all_curves, result);
  if (!surge) return without_surge(curves, vehicle, family, std::move(result));
  const SteadyFit& law = *surge->chosen;
  const std::optional<MassEstimate> stop = by_stop_time(law, stops, result);
  const std::optional<MassEstimate> curve = by_curves(law, curves, result);
  result.estimate = curve ? curve : stop;
  if (stop && curve && law.has_covariance()) {
    std::ranges::move(disagreement(*stop, *curve, law, curves.front().file),
                      std::back_inserter(result.findings));
    result.estimate = combined(*stop, *curve, law);
    result.reports.push_back(
        report_of(*result.estimate, law, Estimator::kCombined, "time and speed"));
  }
  if (joint && !curves.empty()) {
    JointFit fit = fit_joint(surge->problem, law, curves);
    if (fit.covariance.size() > 0) {
      result.reports.push_back(report_of(fit, surge->problem.points.size()));
    }
    if (fit.coast.usable) {
      result.joint = std::move(fit);
    } else {
      result.findings.push_back(
          {curves.front().file, 0, Severity::kWarning, "not-converged",
           "the joint fit of the surge runs and the coast-down failed: " + fit.coast.stop_reason});
    }
  }
  check(law, stops, !curves.empty(), vehicle, result);
  if (result.estimate) {
    check_mass(law.law(), curves, std::exp(result.estimate->log_mass_norm), result.findings);
  }
  return result;
}

}  // namespace awmr
