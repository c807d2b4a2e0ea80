#include "awmr/identify/coastdown/mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/coastdown/coast_alone.h"
#include "awmr/identify/coastdown/coast_model.h"
#include "awmr/identify/coastdown/stop_families.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/tables/profile.h"
#include "awmr/model/log_term_names.h"

namespace awmr {
namespace {

/// Smallest decrease of the speed that counts as a deceleration, from the mean of a curve's first
/// fifth to the mean of its last fifth. Unit: standard deviations of such a mean.
constexpr double kMinimumFall = 5.0;

/// True if the speed falls significantly (kMinimumFall) from the first fifth of the curve to its
/// last fifth. Precondition: three rows.
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

/// Returns the curves whose speed falls. Adds `no-deceleration` to `result` for each other curve.
std::vector<CoastCurve> falling(const std::vector<CoastCurve>& curves, MassResult& result) {
  std::vector<CoastCurve> kept;
  for (const CoastCurve& curve : curves) {
    if (curve.t_s.size() < kFewestRows) {
      result.findings.push_back(
          {curve.file, curve.line, Severity::kWarning, "no-deceleration",
           fmt::format("only {} rows of this coast-down have a speed above 0, so the curve is "
                       "not used for mass_norm; record the speed at a higher rate",
                       curve.t_s.size())});
      continue;
    }
    if (falls(curve)) {
      kept.push_back(curve);
      continue;
    }
    result.findings.push_back(
        {curve.file, curve.line, Severity::kWarning, "no-deceleration",
         "the speed of this coast-down does not fall by more than its noise, so the curve is "
         "not used for mass_norm; record the speed until the vehicle stops"});
  }
  return kept;
}

/// Estimates m' from the stop times. Adds the report to `result`. If the estimate fails, sets
/// `result.reason` instead.
std::optional<MassEstimate> by_stop_time(const SteadyFit& surge,
                                         const std::optional<TrialSet<StopTimeRow>>& stops,
                                         MassResult& result) {
  if (!stops || stops->rows.empty()) return std::nullopt;
  const auto mass = mass_from_stop_time(surge, stops->rows);
  if (!mass) {
    result.reason = fmt::format(
        "the surge exponent {:.4g} is 1 or more: with this law the vehicle never stops, so a "
        "stop time does not determine mass_norm. Choose a family with Coulomb friction ({}), "
        "or record the speed of the coast-down as a curve",
        surge[TransformedParameter::kBeta], option_text("family auto"));
    return std::nullopt;
  }
  const MassEstimate estimate = from_stop_time(*mass, stops->rows.size());
  result.reports.push_back(report_of(estimate, surge, Estimator::kStopTime, "time"));
  result.reports.back().rows_used = static_cast<int>(stops->rows.size());
  return estimate;
}

/// The filter's time constant for /estimates, with its standard error `error`.
EstimatorParameter report_of_lag(const FittedLag& lag, double error, double dof) {
  const double half = t_quantile_95(dof) * error;
  return {std::string(kSensorLagPrefix) + "speed_mps",
          lag.value_s,
          error,
          Interval{std::max(0.0, lag.value_s - half), lag.value_s + half},
          {}};
}

Finding lag_finding(const CoastModel& model, double value_s, double error_s,
                    const std::string& file) {
  const std::string also =
      model.other
          ? fmt::format(
                ", or of {:.2g} s with mass_norm {:.3g}: the curves do not decide between "
                "them, so the interval of mass_norm is withdrawn. ",
                model.other->lag_s, std::exp(model.other->log_mass))
          : ". The fit estimates the time constant of this filter together with mass_norm, which "
            "makes the interval of mass_norm wider. ";
  return {file, 0, Severity::kWarning, "sensor-lag",
          fmt::format("the speed of the coast-downs was low-pass filtered before it was logged, "
                      "with a time constant of {:.3g} +- {:.2g} s{}Log the unfiltered speed, or "
                      "use a filter with a shorter time constant",
                      value_s, error_s, also)};
}

/// Estimates m' from the curves. Adds the report to `result`. If the estimate fails, sets
/// `result.reason` instead.
std::optional<MassEstimate> by_curves(const SteadyFit& surge, const std::vector<CoastCurve>& curves,
                                      const std::optional<CoastModel>& model, MassResult& result) {
  if (curves.empty()) {
    if (result.reason.empty()) result.reason = "no coast-down shows a deceleration";
    return std::nullopt;
  }
  const CoastFit fit = fit_coast(curves, surge, model->start);
  const std::string& file = curves.front().file;
  if (!fit.usable) {
    result.reason = "the fit of the coast-down curve failed: " + fit.stop_reason;
    result.findings.push_back({file, 0, Severity::kWarning, "not-converged", result.reason});
    return std::nullopt;
  }
  const MassEstimate estimate = from_curve(fit);
  result.reports.push_back(report_of(estimate, surge, Estimator::kCurve, "speed"));
  add_curve_figures(result.reports.back(), fit);
  if (fit.lag) {
    const double surge_variance =
        surge.has_covariance() ? fit.lag->by_surge.dot(surge.covariance * fit.lag->by_surge) : 0.0;
    const double error = std::sqrt(fit.lag->variance + surge_variance);
    result.reports.back().parameters.push_back(report_of_lag(*fit.lag, error, fit.dof));
    result.findings.push_back(lag_finding(*model, fit.lag->value_s, error, file));
  }
  if (fit.autocorrelated) {
    result.findings.push_back(
        {file, 0, Severity::kNote, "coloured-residuals",
         "successive residuals of the coast-down curves are correlated: an error of the model or "
         "of the speed sensor lasts for several rows. The interval of mass_norm was widened, so "
         "that it includes this error"});
  }
  return estimate;
}

EstimatorReport report_of(const JointFit& joint, std::size_t surge_rows) {
  EstimatorReport report;
  report.subject = FitSubject::kMass;
  report.estimator = Estimator::kJoint;
  report.noise = "as the surge fit, and speed";
  const Subject surge{};  // names of the surge parameters
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
  if (joint.coast.lag) {
    report.parameters.push_back(
        report_of_lag(*joint.coast.lag, std::sqrt(joint.coast.lag->variance), joint.dof(last)));
  }
  report.rows_used = joint.coast.rows + static_cast<int>(surge_rows);
  report.residual_std = joint.coast.residual_std_mps;
  report.rank = static_cast<int>(joint.covariance.rows());
  report.condition_number = 0.0;
  report.stop_reason = joint.coast.stop_reason;
  return report;
}

/// Estimates m' from stop times, curves or both, for a given surge law. Adds reports and findings
/// to `result`.
std::optional<MassEstimate> estimate_under(const SteadyFit& law,
                                           const std::optional<TrialSet<StopTimeRow>>& stops,
                                           const std::vector<CoastCurve>& curves,
                                           const std::optional<CoastModel>& model,
                                           MassResult& result) {
  const std::optional<MassEstimate> stop = by_stop_time(law, stops, result);
  const std::optional<MassEstimate> curve = by_curves(law, curves, model, result);
  if (!stop || !curve || !law.has_covariance()) return curve ? curve : stop;
  std::ranges::move(disagreement(*stop, *curve, law, curves.front().file),
                    std::back_inserter(result.findings));
  const MassEstimate both = combined(*stop, *curve, law);
  result.reports.push_back(report_of(both, law, Estimator::kCombined, "time and speed"));
  return both;
}

/// Joint distribution of the surge law's coordinates theta and ln m'. With the covariance C of
/// theta, g = d ln m'/d theta and the variance v of ln m' that does not come from theta, the joint
/// covariance is
///   [ C    C g       ]
///   [ g'C  g'C g + v ]
/// Precondition: the law has a covariance.
Posterior::Alternative with_mass(const NoiseAlternative& law, const MassEstimate& mass) {
  Posterior::Alternative joint = posterior_of({law}).alternatives.front();
  const Eigen::Index n = joint.centre.size();
  const Eigen::VectorXd across = law.fit.covariance * mass.by_surge;
  joint.centre.conservativeResize(n + 1);
  joint.centre(n) = mass.log_mass_norm;
  joint.covariance.conservativeResize(n + 1, n + 1);
  joint.covariance.col(n).head(n) = across;
  joint.covariance.row(n).head(n) = across.transpose();
  joint.covariance(n, n) = *mass.variance(law.fit);
  joint.dof.conservativeResize(n + 1);
  joint.dof(n) = mass.dof(law.fit);
  return joint;
}

/// Estimates m' again under each alternative surge law, one for each other error model, and sets
/// `result.posterior`. `result` already contains the estimate under the chosen law.
void add_alternatives(const std::vector<NoiseAlternative>& laws,
                      const std::optional<TrialSet<StopTimeRow>>& stops,
                      const std::vector<CoastCurve>& curves, const std::optional<CoastModel>& model,
                      MassResult& result) {
  if (!result.estimate || laws.empty() || !laws.front().fit.has_covariance()) return;
  const std::size_t own_report = result.reports.size() - 1;
  result.posterior.alternatives = {with_mass(laws.front(), *result.estimate)};
  double sum = laws.front().weight;
  for (std::size_t k = 1; k < laws.size(); ++k) {
    MassResult under;
    const auto mass = estimate_under(laws[k].fit, stops, curves, model, under);
    if (!mass) continue;
    Posterior::Alternative joint = with_mass(laws[k], *mass);
    if (!Posterior{{joint}}.is_proper(joint.centre.size() - 1)) continue;
    result.posterior.alternatives.push_back(std::move(joint));
    sum += laws[k].weight;
    result.reports.push_back(std::move(under.reports.back()));
    result.reports.back().weight = laws[k].weight;
    result.reports.back().noise += fmt::format("; surge: {}", name_of(laws[k].noise));
  }
  for (Posterior::Alternative& k : result.posterior.alternatives) k.weight /= sum;
  if (result.posterior.alternatives.size() < 2) return;
  result.reports[own_report].weight = laws.front().weight;
  for (std::size_t r = own_report; r < result.reports.size(); ++r) *result.reports[r].weight /= sum;
}

/// Adds the finding `noise-model` if m' depends on the error model: its median over all surge laws
/// differs from the reported m' by more than the standard error. `has_curves`: the coast-downs
/// include curves.
void check_noise(const std::vector<NoiseAlternative>& laws, const std::string& file,
                 bool has_curves, MassResult& result) {
  if (result.posterior.alternatives.size() < 2) return;
  const Eigen::Index last = result.posterior.alternatives.front().centre.size() - 1;
  if (!result.posterior.is_proper(last)) return;
  const double median = result.posterior.quantile(last, 0.5);
  const double off = std::abs(median - result.estimate->log_mass_norm);
  if (off * off < *result.estimate->variance(laws.front().fit)) return;
  result.findings.push_back(
      {file, 0, Severity::kWarning, "noise-model",
       fmt::format(
           "mass_norm depends on which quantity of the surge runs has the measurement error, "
           "which is unknown. It is {:.3g} with errors on {}; the median over all such error "
           "models is {:.3g} (weights in /estimates of model.json). Its interval, and the "
           "random vehicles of tune and compare, cover all error models. Select one with {}, "
           "or record {}",
           std::exp(result.estimate->log_mass_norm), name_of(laws.front().noise), std::exp(median),
           option_text("noise"),
           has_curves ? "further surge runs, which make the surge resistance more accurate"
                      : "a coast-down curve, whose mass_norm depends less on the surge "
                        "resistance")});
}

/// MassResult::by_grip, from the coast-down with the highest initial speed.
std::optional<double> demanded_by_grip(const SteadyFit& surge,
                                       const std::optional<TrialSet<StopTimeRow>>& stops,
                                       const std::vector<CoastCurve>& curves, double mass_norm) {
  double fastest_mps = 0.0;
  if (stops) {
    for (const StopTimeRow& run : stops->rows) {
      fastest_mps = std::max(fastest_mps, run.initial_speed_mps);
    }
  }
  for (const CoastCurve& curve : curves) {
    fastest_mps = std::max(fastest_mps, curve.speed_mps.front());
  }
  if (!is_implausible(surge.law(), fastest_mps, mass_norm)) return std::nullopt;
  return mass_norm_by_grip(surge.law(), fastest_mps);
}

/// Fits surge rows and curves together and adds the report; sets `result.joint` if it converges.
void add_joint(const SteadyProblem& surge, const SteadyFit& law,
               const std::vector<CoastCurve>& curves, const CoastStart& start, MassResult& result) {
  JointFit fit = fit_joint(surge, law, curves, start);
  if (fit.covariance.size() > 0) result.reports.push_back(report_of(fit, surge.points.size()));
  if (fit.coast.usable) {
    result.joint = std::move(fit);
  } else {
    result.findings.push_back({curves.front().file, 0, Severity::kWarning, "not-converged",
                               "the joint fit of the surge runs and the coast-down failed, so the "
                               "values are those of the "
                               "separate fits: " +
                                   fit.coast.stop_reason});
  }
}

void withdraw_mass(MassResult& result) {
  result.posterior = {};
  for (EstimatorReport& report : result.reports) {
    for (EstimatorParameter& parameter : report.parameters) withdraw(parameter);
  }
}

/// The note `back-emf-assumed`. If the motors have back-EMF k_e (n driven wheels), surge runs give
/// g1 + n k_e u instead of the surge resistance g1, but only g1 brakes a coast-down. The mass m' =
/// g1/|u_dot| is then too large.
Finding assumed_back_emf(const std::string& file) {
  return {file, 0, Severity::kNote, "back-emf-assumed",
          "mass_norm assumes that at a constant command the force of a motor does not fall with "
          "the speed. For voltage-driven motors that coast at a command of 0, mass_norm is too "
          "large by the factor 1 + n k_e u/g1 (n: number of driven wheels, u: speed, g1: surge "
          "resistance divided by F_max). If the force does not fall, set motor.back_emf_s_per_m to "
          "0 in the vehicle file; if it does, identify the vehicle from a log with driven and "
          "coasting sections, without surge and turning tables"};
}

/// Adds the findings about m'. Adds `fragile-mass` only if m' comes from stop times alone.
void check(const SteadyFit& surge, const std::optional<TrialSet<StopTimeRow>>& stops,
           const std::vector<CoastCurve>& curves, const Vehicle& vehicle, MassResult& result) {
  if (!result.estimate) return;
  if (!vehicle.back_emf_s_per_m) {
    result.findings.push_back(assumed_back_emf(stops ? stops->file : curves.front().file));
  }
  const double mass_norm = std::exp(result.estimate->log_mass_norm);
  std::optional<double> deviation;
  if (!result.posterior.empty() && curves.empty()) {
    const Eigen::MatrixXd covariance = result.posterior.covariance();
    deviation = std::sqrt(covariance(covariance.rows() - 1, covariance.rows() - 1));
  }
  if (stops) {
    check_mass(surge.law(), *stops, vehicle.mass_kg, mass_norm, deviation, result.findings);
    for (Finding& finding : result.findings) {
      if (finding.code == "fragile-mass") finding.message += result.other_family;
    }
  }
  check_mass(surge.law(), curves, mass_norm, result.findings);
  result.by_grip = demanded_by_grip(surge, stops, curves, mass_norm);
}

}  // namespace

std::optional<FamilyOfCurves> family_of_curves(const SubjectFit& surge,
                                               const std::vector<CoastCurve>& curves) {
  if (surge.undecided.size() < 2 || curves.empty()) return std::nullopt;
  MassResult ignored;
  CoastReadings readings = measured_rows(curves, ignored.findings);
  readings.curves = falling(readings.curves, ignored);
  std::vector<ScoredLaw> laws;
  for (const FamilyCandidate& one : surge.undecided) laws.push_back({one.fit, *aicc(one.fit)});
  const auto best = law_of_curves(readings, laws);
  if (!best) return std::nullopt;
  return FamilyOfCurves{surge.undecided[best->index].problem.family, best->decrease};
}

MassResult estimate_mass(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                         const std::vector<CoastCurve>& all_curves, const Vehicle& vehicle,
                         const FamilyChoice& family, bool joint) {
  MassResult result;
  CoastReadings readings = measured_rows(all_curves, result.findings);
  readings.curves = falling(readings.curves, result);
  const std::vector<CoastCurve>& curves = readings.curves;
  if (!surge) return without_surge(curves, vehicle, family, std::move(result));
  const SteadyFit& law = *surge->chosen;
  std::optional<CoastModel> model;
  if (!curves.empty()) model = choose_coast_model(readings, law);
  result.estimate = estimate_under(law, stops, curves, model, result);
  add_alternatives(surge->alternatives, stops, curves, model, result);
  if (model) {
    std::ranges::move(inadequacy(*model, curves.front().file), std::back_inserter(result.findings));
  }
  const bool withdraws = model && model->withdraws_intervals();
  if (joint && model && !withdraws) add_joint(surge->problem, law, curves, model->start, result);
  const std::string stop_file = stops ? stops->file : std::string();
  if (!result.joint) {
    check_noise(surge->alternatives, curves.empty() ? stop_file : curves.front().file,
                !curves.empty(), result);
  }
  // A coast-down curve measures g1 down to low speeds, so that m' needs no such average.
  const bool is_named = family.requested && family.family;
  if (stops && curves.empty() && !is_named) average_over_families(*surge, stops->rows, result);
  if (withdraws) withdraw_mass(result);
  check(law, stops, curves, vehicle, result);
  return result;
}

}  // namespace awmr
