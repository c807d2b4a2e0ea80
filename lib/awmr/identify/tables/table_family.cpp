#include "awmr/identify/tables/table_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "awmr/identify/tables/profile.h"

namespace awmr {
namespace {

/// Largest number of runs with profile intervals, each of which takes about a hundred fits. If
/// there are more runs, the interval from the standard error is nearly the same.
constexpr Eigen::Index kMaximumProfileRows = kExactRows;

/// Adds to the report the profile-likelihood interval of every parameter that has a standard error.
/// Skips intervals that the data do not bound at both ends.
void add_profiles(FamilyCandidate& candidate) {
  const std::vector<TransformedParameter> coordinates = coordinates_of(candidate.problem.family);
  for (std::size_t i = 0; i < candidate.report.parameters.size(); ++i) {
    const TransformedParameter c = coordinates[i];
    if (!candidate.fit.std_error(c)) continue;
    const Interval interval = values_from(c, profile_interval(candidate.problem, candidate.fit, c));
    if (!std::isfinite(interval.lo) || !std::isfinite(interval.hi)) continue;
    candidate.report.parameters[i].profile95 = interval;
  }
}

FamilyCandidate candidate_from(const Subject& subject, const SteadyProblem& problem,
                               ErrorModel wanted, SteadyFit found) {
  const bool squared = problem.loss == Loss::kSquared;
  FamilyCandidate candidate{problem, std::move(found), {}};
  const SteadyFit& fit = candidate.fit;
  candidate.report =
      report_of(subject, fit, problem.family, Estimator::kNonlinear, name_of(problem.noise));
  if (!squared) candidate.report.noise += ", " + title_of(problem.loss);
  candidate.report.aicc = squared ? aicc(fit) : std::nullopt;
  if (problem.noise == wanted && squared && fit.has_covariance() && fit.usable) {
    if (rows_of(problem.points) > kMaximumProfileRows) {
      candidate.report.stop_reason += fmt::format(
          "; no profile intervals, because there are more than {} rows", kMaximumProfileRows);
    } else {
      add_profiles(candidate);
    }
  }
  return candidate;
}

/// The pairs of family and error model that fit_candidates() fits, in the order of the reports.
std::vector<std::pair<Family, ErrorModel>> plan(const Subject& subject,
                                                const SubjectOptions& options, ErrorModel wanted) {
  std::vector<std::pair<Family, ErrorModel>> fits;
  if (!options.side_by_side) {
    if (options.method == Method::kLogLinear) return fits;
    if (options.family.family) return {{*options.family.family, wanted}};
    for (const Family family : subject.families) fits.emplace_back(family, wanted);
    return fits;
  }
  for (const ErrorModel noise : {ErrorModel::kForce, ErrorModel::kSpeed, ErrorModel::kTime}) {
    if (noise == ErrorModel::kTime && !all_timed(subject.points)) continue;
    fits.emplace_back(Family::kPower, noise);
  }
  if (wanted == ErrorModel::kLogForce) fits.emplace_back(Family::kPower, wanted);
  for (const Family family : subject.families) {
    if (family != Family::kPower) fits.emplace_back(family, wanted);
  }
  return fits;
}

}  // namespace

bool all_timed(const std::vector<SteadyPoint>& points) {
  return std::all_of(points.begin(), points.end(),
                     [](const SteadyPoint& p) { return p.travel && p.elapsed_s; });
}

bool only_timed(const std::vector<SteadyPoint>& points) {
  constexpr double kRounding = 1e-9;
  return std::all_of(points.begin(), points.end(), [](const SteadyPoint& p) {
    return p.travel && p.elapsed_s &&
           std::abs(p.rate * *p.elapsed_s - *p.travel) <= kRounding * *p.travel;
  });
}

ErrorModel wanted_noise(const Subject& subject, const SubjectOptions& options) {
  const bool is_assumed = options.noise == ErrorModel::kLogForce && !options.knows_noise;
  if (is_assumed && options.loss == Loss::kSquared && only_timed(subject.points)) {
    return ErrorModel::kTime;
  }
  return options.noise.value_or(all_timed(subject.points) ? ErrorModel::kTime : ErrorModel::kSpeed);
}

std::vector<FamilyCandidate> fit_candidates(const Subject& subject, const SubjectOptions& options,
                                            ErrorModel wanted, const SteadyFit& line) {
  std::vector<FamilyCandidate> candidates;
  std::map<ErrorModel, std::map<Family, TransformedParameters>> known;
  for (const auto& [family, noise] : plan(subject, options, wanted)) {
    if (subject.points.size() < coordinates_of(family).size()) continue;
    const SteadyProblem problem{subject.points, family, noise, options.loss, subject.beta_range};
    SteadyFit fit = family == Family::kPower ? fit_steady(problem, line.theta)
                                             : fit_steady(problem, known[noise]);
    known[noise][family] = fit.theta;
    candidates.push_back(candidate_from(subject, problem, wanted, std::move(fit)));
  }
  return candidates;
}

std::vector<FamilyCandidate> fit_families(const Subject& subject, ErrorModel noise, Family first) {
  std::vector<Family> families{first};
  for (const Family family : subject.families) {
    if (family != first) families.push_back(family);
  }
  std::vector<FamilyCandidate> candidates;
  std::map<Family, TransformedParameters> known;
  for (const Family family : families) {
    if (subject.points.size() < coordinates_of(family).size()) continue;
    const SteadyProblem problem{subject.points, family, noise, Loss::kSquared, subject.beta_range};
    candidates.push_back({problem, fit_steady(problem, known), {}});
    known[family] = candidates.back().fit.theta;
  }
  return candidates;
}

const FamilyCandidate* candidate_of(const std::vector<FamilyCandidate>& candidates, Family family,
                                    ErrorModel noise) {
  for (const FamilyCandidate& c : candidates) {
    if (c.problem.family == family && c.problem.noise == noise) return &c;
  }
  return nullptr;
}

const FamilyCandidate* best_candidate(const std::vector<FamilyCandidate>& candidates,
                                      ErrorModel noise) {
  const FamilyCandidate* best = nullptr;
  for (const FamilyCandidate& c : candidates) {
    if (c.problem.noise != noise || !c.fit.usable || !aicc(c.fit)) continue;
    if (!best || *aicc(c.fit) < *aicc(best->fit)) best = &c;
  }
  return best;
}

std::string method_in_words(const SteadyProblem& problem) {
  std::string words = fmt::format("nonlinear, noise on {}", name_of(problem.noise));
  if (problem.family != Family::kPower) words += fmt::format(", {}", name_of(problem.family));
  if (problem.loss != Loss::kSquared) words += ", " + title_of(problem.loss);
  return words;
}

}  // namespace awmr
