#include "awmr/identify/coastdown/mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "awmr/identify/uncertainty/diagnostics.h"

namespace awmr {
namespace {

constexpr double kDisagreement = 0.01;  ///< p below which two estimates of one thing disagree
/// A curve whose speed falls by less than this many deviations of its noise shows no deceleration.
constexpr double kLeastFall = 5.0;

MassEstimate from_stop_time(const MassFromStopTime& mass, std::size_t runs) {
  return {mass.log_mass_norm, mass.by_surge, mass.timing_variance,
          runs > 1 ? static_cast<double>(runs - 1) : 1e9, "stop time"};
}

MassEstimate from_curve(const CoastFit& fit) {
  return {fit.log_mass_norm, fit.by_surge, fit.variance, fit.dof, "coast-down curve"};
}

/// w a + (1 - w) b of least variance, the surge fit's share being common to both.
MassEstimate combined(const MassEstimate& a, const MassEstimate& b, const SteadyFit& surge) {
  const Eigen::VectorXd d = a.by_surge - b.by_surge;
  const double between = d.dot(surge.covariance * d) + a.own_variance + b.own_variance;
  const double w =
      between > 0.0 ? (b.own_variance - d.dot(surge.covariance * b.by_surge)) / between : 0.5;
  const double v = w * w * a.own_variance + (1.0 - w) * (1.0 - w) * b.own_variance;
  const double parts = std::pow(w * w * a.own_variance, 2) / a.own_dof +
                       std::pow((1.0 - w) * (1.0 - w) * b.own_variance, 2) / b.own_dof;
  return {w * a.log_mass_norm + (1.0 - w) * b.log_mass_norm,
          w * a.by_surge + (1.0 - w) * b.by_surge, v, parts > 0.0 ? v * v / parts : 1e9,
          "stop time and coast-down curve"};
}

EstimatorReport report_of(const MassEstimate& mass, const SteadyFit& surge,
                          Estimator estimator, const std::string& noise) {
  EstimatorReport report;
  report.subject = FitSubject::kMass;
  report.estimator = estimator;
  report.noise = noise;
  EstimatorParameter parameter{"mass_norm", std::exp(mass.log_mass_norm), {}, {}, {}};
  if (const auto variance = mass.variance(surge)) {
    const double deviation = std::sqrt(*variance);
    const double half = t_quantile_95(mass.dof(surge)) * deviation;
    parameter.std_error = parameter.value * deviation;
    parameter.ci95 =
        Interval{std::exp(mass.log_mass_norm - half), std::exp(mass.log_mass_norm + half)};
  }
  report.parameters = {parameter};
  report.rank = 1;
  report.condition_number = 1.0;
  report.stop_reason = "closed form";
  return report;
}

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

/// Deviation of ln m' that two estimates may differ by, against what they differ by.
void compare(const MassEstimate& a, const MassEstimate& b, const SteadyFit& surge,
             const std::string& file, std::vector<Finding>& findings) {
  if (!surge.has_covariance()) return;
  const Eigen::VectorXd d = a.by_surge - b.by_surge;
  const double deviation = std::sqrt(d.dot(surge.covariance * d) + a.own_variance + b.own_variance);
  const double z = std::abs(a.log_mass_norm - b.log_mass_norm) / deviation;
  const double p = 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), z));
  if (p >= kDisagreement) return;
  findings.push_back(
      {file, 0, Severity::kWarning, "estimates-disagree",
       fmt::format("mass_norm is {:.4g} by the {} and {:.4g} by the {}: {:.1f} standard deviations "
                   "apart (p = {:.2g}); one of the two trials, or the resistance law, is wrong",
                   std::exp(a.log_mass_norm), a.method, std::exp(b.log_mass_norm), b.method, z,
                   p)});
}

/// Speeds that only wander about one level.
bool falls(const CoastCurve& curve) {
  const std::size_t part = std::max<std::size_t>(2, curve.speed_mps.size() / 5);
  const auto mean = [&](std::size_t begin) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + part; ++i) sum += curve.speed_mps[i];
    return sum / static_cast<double>(part);
  };
  double squares = 0.0;
  for (std::size_t i = 1; i < curve.speed_mps.size(); ++i) {
    const double step = curve.speed_mps[i] - curve.speed_mps[i - 1];
    squares += step * step;
  }
  const double noise = std::sqrt(squares / (2.0 * static_cast<double>(curve.speed_mps.size())));
  const double fall = mean(0) - mean(curve.speed_mps.size() - part);
  return fall > kLeastFall * noise / std::sqrt(static_cast<double>(part)) && fall > 0.0;
}

/// estimate_mass() in steps.
class MassEstimator {
 public:
  MassEstimator(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                const std::vector<CoastCurve>& curves, const Vehicle& vehicle)
      : surge_(surge), stops_(stops), vehicle_(vehicle) {
    for (const CoastCurve& curve : curves) {
      if (falls(curve)) {
        curves_.push_back(curve);
        continue;
      }
      result_.findings.push_back(
          {curve.file, curve.line, Severity::kWarning, "no-deceleration",
           "the speed of this coast-down does not fall by more than its noise: it shows nothing of "
           "m' and is set aside"});
    }
  }

  MassResult run(bool joint) {
    if (!surge_) {
      without_surge();
      return std::move(result_);
    }
    const SteadyFit& surge = *surge_->chosen;
    std::optional<MassEstimate> stop = stop_time(surge);
    std::optional<MassEstimate> curve = whole_curve(surge);
    if (stop && curve) compare(*stop, *curve, surge, curves_.front().file, result_.findings);
    if (stop && curve && surge.has_covariance()) {
      result_.estimate = combined(*stop, *curve, surge);
      result_.reports.push_back(report_of(*result_.estimate, surge, Estimator::kCombined, "time and speed"));
    } else {
      result_.estimate = curve ? curve : stop;
    }
    if (joint && !curves_.empty()) fit_jointly();
    check(surge);
    return std::move(result_);
  }

 private:
  void without_surge() {
    result_.reason = "a coast-down shows m' only together with a1 and b1, which are not identified";
    if (curves_.empty()) return;
    CoastFit fit = fit_coast_alone(curves_, vehicle_.surge_beta_range);
    if (!fit.usable) {
      result_.reason += fmt::format(" (the fit of the curve alone: {})", fit.stop_reason);
      return;
    }
    const double ratio = std::exp(fit.log_mass_norm);
    const double error = std::sqrt(fit.variance);
    const double half = t_quantile_95(fit.dof);
    result_.reason = fmt::format(
        "a coast-down curve fixes only the ratio m'/a1 = {:.4g} +- {:.2g} and the exponent b1 = "
        "{:.4g}, not m' itself",
        ratio, ratio * error, fit.beta);
    EstimatorReport report;
    report.subject = FitSubject::kMass;
    report.estimator = Estimator::kCurve;
    report.noise = "speed";
    const double beta_error = std::sqrt(fit.beta_variance);
    report.parameters = {{std::string(kMassOverSurgeName),
                          ratio,
                          ratio * error,
                          Interval{ratio * std::exp(-half * error), ratio * std::exp(half * error)},
                          {}},
                         {"surge.beta",
                          fit.beta,
                          beta_error,
                          Interval{fit.beta - half * beta_error, fit.beta + half * beta_error},
                          {}}};
    add_curve_figures(report, fit);
    result_.reports.push_back(std::move(report));
    result_.alone = std::move(fit);
  }

  std::optional<MassEstimate> stop_time(const SteadyFit& surge) {
    if (!stops_ || stops_->rows.empty()) return std::nullopt;
    const auto mass = mass_from_stop_time(surge, stops_->rows);
    if (!mass) {
      result_.reason = fmt::format(
          "the surge exponent {:.4g} is 1 or more: with it the vehicle never stops, and a stop "
          "time "
          "says nothing",
          surge[TransformedParameter::kBeta]);
      return std::nullopt;
    }
    MassEstimate estimate = from_stop_time(*mass, stops_->rows.size());
    result_.reports.push_back(report_of(estimate, surge, Estimator::kStopTime, "time"));
    result_.reports.back().rows_used = static_cast<int>(stops_->rows.size());
    return estimate;
  }

  std::optional<MassEstimate> whole_curve(const SteadyFit& surge) {
    if (curves_.empty()) {
      if (result_.reason.empty()) result_.reason = "no coast-down shows a deceleration";
      return std::nullopt;
    }
    const CoastFit fit = fit_coast(curves_, surge);
    if (!fit.usable) {
      result_.reason = "the fit of the coast-down curve failed: " + fit.stop_reason;
      result_.findings.push_back(
          {curves_.front().file, 0, Severity::kWarning, "not-converged", result_.reason});
      return std::nullopt;
    }
    MassEstimate estimate = from_curve(fit);
    result_.reports.push_back(report_of(estimate, surge, Estimator::kCurve, "speed"));
    add_curve_figures(result_.reports.back(), fit);
    if (fit.autocorrelated) {
      result_.findings.push_back(
          {curves_.front().file, 0, Severity::kNote, "coloured-residuals",
           "neighbouring residuals of the coast-down are correlated; the interval of mass_norm "
           "allows for it"});
    }
    return estimate;
  }

  void fit_jointly() {
    JointFit joint = fit_joint(surge_->problem, *surge_->chosen, curves_);
    EstimatorReport report;
    report.subject = FitSubject::kMass;
    report.estimator = Estimator::kJoint;
    report.noise = "as the surge fit, and speed";
    for (std::size_t i = 0; i < joint.surge.free.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const TransformedParameter c = joint.surge.free[i];
      const double error = std::sqrt(joint.covariance(at, at));
      const double half = t_quantile_95(joint.dof(at)) * error;
      const double x = joint.surge[c];
      const char* name = c == TransformedParameter::kLogAlpha    ? "surge.alpha"
                         : c == TransformedParameter::kBeta      ? "surge.beta"
                         : c == TransformedParameter::kCoulomb   ? "surge.coulomb"
                         : c == TransformedParameter::kQuadratic ? "surge.quadratic"
                                                       : "wheel.dead_zone";
      report.parameters.push_back({name,
                                   value_from(c, x),
                                   jacobian_of(c, x) * error,
                                   Interval{value_from(c, x - half), value_from(c, x + half)},
                                   {}});
    }
    const Eigen::Index last = joint.covariance.rows() - 1;
    const double error = std::sqrt(joint.covariance(last, last));
    const double half = t_quantile_95(joint.dof(last)) * error;
    const double mass = std::exp(joint.log_mass_norm);
    report.parameters.push_back({"mass_norm",
                                 mass,
                                 mass * error,
                                 Interval{mass * std::exp(-half), mass * std::exp(half)},
                                 {}});
    report.rows_used = joint.coast.rows + static_cast<int>(surge_->problem.points.size());
    report.residual_std = joint.coast.residual_std_mps;
    report.rank = static_cast<int>(joint.covariance.rows());
    report.condition_number = 0.0;
    report.stop_reason = joint.coast.stop_reason;
    result_.reports.push_back(std::move(report));
    if (joint.coast.usable) result_.joint = std::move(joint);
  }

  void check(const SteadyFit& surge) {
    if (!result_.estimate || !stops_) return;
    const auto variance = result_.estimate->variance(surge);
    std::optional<double> deviation;
    if (variance && curves_.empty()) deviation = std::sqrt(*variance);
    check_mass(surge.law(), *stops_, vehicle_.mass_kg, std::exp(result_.estimate->log_mass_norm),
               deviation, result_.findings);
  }

  const SubjectFit* surge_;
  const std::optional<TrialSet<StopTimeRow>>& stops_;
  std::vector<CoastCurve> curves_;
  const Vehicle& vehicle_;
  MassResult result_;
};

}  // namespace

std::optional<double> MassEstimate::variance(const SteadyFit& surge) const {
  if (!surge.has_covariance()) return std::nullopt;
  return by_surge.dot(surge.covariance * by_surge) + own_variance;
}

double MassEstimate::dof(const SteadyFit& surge) const {
  const double from_surge = by_surge.dot(surge.covariance * by_surge);
  const double total = from_surge + own_variance;
  const double parts =
      from_surge * from_surge / surge.degrees_of_freedom + own_variance * own_variance / own_dof;
  return parts > 0.0 ? total * total / parts : static_cast<double>(surge.degrees_of_freedom);
}

MassResult estimate_mass(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                         const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         bool joint) {
  return MassEstimator(surge, stops, curves, vehicle).run(joint);
}

}  // namespace awmr
