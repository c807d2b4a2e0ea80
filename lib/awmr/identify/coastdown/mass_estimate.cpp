#include "awmr/identify/coastdown/mass_estimate.h"

#include <fmt/format.h>

#include <cmath>

#include "awmr/core/statistics/distributions.h"

namespace awmr {
namespace {

constexpr double kDisagreement = 0.01;  ///< two estimates disagree if p is below this value

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

MassEstimate from_stop_time(const MassFromStopTime& mass, std::size_t runs) {
  return {mass.log_mass_norm, mass.by_surge, mass.timing_variance,
          runs > 1 ? static_cast<double>(runs - 1) : 1e9, "stop time"};
}

MassEstimate from_curve(const CoastFit& fit) {
  return {fit.log_mass_norm, fit.by_surge, fit.variance, fit.dof, "coast-down curve"};
}

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

std::vector<Finding> disagreement(const MassEstimate& a, const MassEstimate& b,
                                  const SteadyFit& surge, const std::string& file) {
  if (!surge.has_covariance()) return {};
  const Eigen::VectorXd d = a.by_surge - b.by_surge;
  const double deviation = std::sqrt(d.dot(surge.covariance * d) + a.own_variance + b.own_variance);
  const double z = std::abs(a.log_mass_norm - b.log_mass_norm) / deviation;
  if (!std::isfinite(z)) return {};
  const double p = 2.0 * normal_tail(z);
  if (p >= kDisagreement) return {};
  return {{file, 0, Severity::kWarning, "estimates-disagree",
           fmt::format(
               "mass_norm is {:.4g} by the {} and {:.4g} by the {}, {:.1f} standard deviations "
               "apart (p = {:.2g}); check both trials and the resistance family",
               std::exp(a.log_mass_norm), a.method, std::exp(b.log_mass_norm), b.method, z, p)}};
}

EstimatorReport report_of(const MassEstimate& mass, const SteadyFit& surge, Estimator estimator,
                          std::string_view noise) {
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

}  // namespace awmr
