#include "awmr/identify/tables/gross_outlier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/uncertainty/diagnostics.h"

namespace awmr {
namespace {

/// Misfit of a resistance curve g to all runs: root mean square of ln(g(w) + z) - ln f. w and f are
/// the rate and the force of a run, z is the dead zone. Infinite if the curve is not finite.
double log_misfit(const FamilyCandidate& candidate) {
  SteadyProblem problem = candidate.problem;
  problem.noise = ErrorModel::kLogForce;
  const auto rows = steady_rows(problem, candidate.fit.theta, {});
  if (!rows) return std::numeric_limits<double>::infinity();
  return std::sqrt(rows->residuals.squaredNorm() / static_cast<double>(rows->residuals.size()));
}

/// Deviation of a run's time from a fit to the times of the other runs, in standard deviations.
/// Infinite if the runs were not timed or the fit fails; the force alone then decides.
double deviations_in_time(const Subject& subject, std::size_t point, const SteadyFit& of_others) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  auto all = by_time({.points = subject.points, .beta_range = subject.beta_range});
  if (!all) return kUnknown;
  SteadyProblem one = *all;
  one.points = {all->points[point]};
  all->points.erase(all->points.begin() + eigen_index(point));
  const SteadyFit fit = fit_steady(*all, of_others.theta);
  if (!fit.usable || !fit.has_covariance()) return kUnknown;
  const auto row = steady_rows(one, fit.theta, fit.free);
  if (!row) return kUnknown;
  const double variance =
      fit.residual_std * fit.residual_std +
      row->jacobian.row(0).dot(fit.covariance * row->jacobian.row(0).transpose());
  return std::abs(row->residuals(0)) / std::sqrt(variance);
}

Subject without(Subject subject, std::size_t point) {
  subject.points.erase(subject.points.begin() + eigen_index(point));
  return subject;
}

}  // namespace

std::optional<GrossOutlier> gross_outlier(const Subject& subject, const SubjectOptions& options) {
  constexpr double kFar = 10.0;
  constexpr double kUnlikely = 0.001;
  constexpr double kAsClose = 3.0;
  const SteadyFit line = fit_log_linear(subject.points);
  if (!line.usable) return std::nullopt;
  const Eigen::VectorXd t = studentised(line.residuals, line.leverages, line.degrees_of_freedom);
  if (t.size() == 0) return std::nullopt;
  Eigen::Index farthest = 0;
  const double deviations = t.cwiseAbs().maxCoeff(&farthest);
  const double p = 2.0 * students_t_tail(deviations, line.degrees_of_freedom - 1) *
                   static_cast<double>(t.size());
  if (!(deviations > kFar) || !(p < kUnlikely)) return std::nullopt;
  const SteadyFit of_others = fit_log_linear(without(subject, at(farthest)).points);
  if (!(deviations_in_time(subject, at(farthest), of_others) > kFar)) return std::nullopt;
  SubjectOptions every_family = options;
  every_family.side_by_side = true;
  for (const FamilyCandidate& candidate :
       fit_candidates(subject, every_family, wanted_noise(subject, options), line)) {
    if (log_misfit(candidate) < kAsClose * of_others.residual_std) return std::nullopt;
  }
  return GrossOutlier{at(farthest), deviations};
}

Finding set_aside(const Subject& subject, const GrossOutlier& outlier) {
  return {subject.file, subject.points[outlier.point].line, Severity::kWarning, "outlier",
          fmt::format("this run deviates by {:.3g} standard deviations from the curve of the "
                      "other runs and is excluded from the fit; correct it, or keep it with {}",
                      outlier.deviations, option_text("as-is"))};
}

}  // namespace awmr
