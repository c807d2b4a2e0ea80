#include "awmr/identify/tables/residual_checks.h"

#include <fmt/format.h>

#include <cmath>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/uncertainty/diagnostics.h"

namespace awmr {
namespace {

constexpr double kOutlierLevel = 0.05;  ///< significance level for the whole table (Bonferroni)

Finding outside_range(const Subject& subject, double beta) {
  const Interval& range = subject.beta_range;
  return {subject.file, 0, Severity::kWarning, "exponent-at-bound",
          fmt::format("the exponent {} = {:.4g} is outside the accepted range [{:g}, {:g}], so a "
                      "power law may not describe these runs; try another resistance family",
                      info(subject.beta).name, beta, range.lo, range.hi)};
}

}  // namespace

Finding held_exponent(const Subject& subject, const SteadyFit& fit) {
  const Interval& range = subject.beta_range;
  const double beta = fit[TransformedParameter::kBeta];
  const bool surge = subject.beta == ParameterId::kSurgeBeta;
  const std::string remedy =
      beta >= range.hi
          ? fmt::format("set \"{}\": [{:g}, {:g}] in the vehicle file to accept larger exponents",
                        surge ? "surge_beta_range" : "yaw_beta_range", range.lo, 2.0 * range.hi)
          : std::string("use a family with Coulomb friction, which describes a force at rest");
  return {subject.file, 0, Severity::kError, "exponent-at-bound",
          fmt::format("the search for {} ended at {:.4g}, a limit of the accepted range [{:g}, "
                      "{:g}]. These runs do not determine the exponent, so the fit is refused; {}",
                      info(subject.beta).name, beta, range.lo, range.hi, remedy)};
}

std::vector<Finding> bound_findings(const Subject& subject, const SteadyFit& fit, Family family) {
  std::vector<Finding> findings;
  if (fit.degrees_of_freedom == 0) {
    findings.push_back(
        {subject.file, 0, Severity::kWarning, "no-degrees-of-freedom",
         fmt::format(
             "{} rows determine the {} parameters of the {} resistance exactly, so there are "
             "no residuals for a standard error; record another run",
             subject.points.size(), fit.free.size(), name_in(kFitSubjectNames, subject.name))});
  }
  const double beta = fit[TransformedParameter::kBeta];
  if (terms_of(family).beta && !subject.beta_range.contains(beta)) {
    findings.push_back(outside_range(subject, beta));
  }
  for (const TransformedParameter c : fit.at_bound) {
    if (c == TransformedParameter::kBeta) continue;
    findings.push_back({subject.file, 0, Severity::kNote, "term-at-zero",
                        fmt::format("{} is 0, the lower end of its range: these runs are described "
                                    "as well without this term, so a family without it suffices",
                                    info(parameter_of(subject, c)).name)});
  }
  return findings;
}

std::vector<Diagnostic> residual_tests(const Subject& subject, const SteadyFit& fit) {
  std::vector<double> forces;
  for (const SteadyPoint& point : subject.points) forces.push_back(point.force);
  std::vector<Diagnostic> tests;
  for (const auto& test : {normality({fit.residuals.data(), at(fit.residuals.size())}),
                           curvature(forces, fit.residuals),
                           lack_of_fit(forces, fit.residuals, static_cast<int>(fit.free.size()))}) {
    if (test) tests.push_back(*test);
  }
  return tests;
}

std::vector<Finding> outlier_findings(const Subject& subject, const SteadyProblem& problem,
                                      const SteadyFit& fit) {
  std::vector<Finding> findings;
  Eigen::VectorXd t = studentised(fit.residuals, fit.leverages, fit.degrees_of_freedom);
  if (const auto timed = by_time(problem)) {
    const SteadyFit of_times = fit_steady(*timed, fit.theta);
    const Eigen::VectorXd other =
        studentised(of_times.residuals, of_times.leverages, of_times.degrees_of_freedom);
    if (of_times.usable && other.size() == t.size()) t = t.cwiseAbs().cwiseMin(other.cwiseAbs());
  }
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    const double p = 2.0 * students_t_tail(std::abs(t(i)), fit.degrees_of_freedom - 1) *
                     static_cast<double>(t.size());
    if (p > kOutlierLevel) continue;
    findings.push_back(
        {subject.file, subject.points[at(i)].line, Severity::kWarning, "outlier",
         fmt::format("this run deviates by {:.1f} standard deviations from the curve of the "
                     "other runs (probability of such a run among {}: {:.2g}); check this run, "
                     "or use a robust loss ({})",
                     std::abs(t(i)), t.size(), p, option_text("loss huber"))});
  }
  return findings;
}

}  // namespace awmr
