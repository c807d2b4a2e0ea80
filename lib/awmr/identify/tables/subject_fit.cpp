#include "awmr/identify/tables/subject_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/identify/tables/gross_outlier.h"
#include "awmr/identify/tables/influence.h"
#include "awmr/identify/tables/profile.h"
#include "awmr/identify/tables/residual_checks.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Smallest number n of runs for which AICc exists. Its denominator n - p - 2 must be positive, and
/// the smallest families have p = 2 parameters.
constexpr std::size_t kMinToCompare = 5;

/// The chosen fit (empty if none is accepted), with the index of its report in SubjectFit::reports.
struct Choice {
  std::optional<SteadyFit> fit;
  SteadyProblem problem;
  std::string method;
  std::size_t report = 0;
  std::vector<Finding> findings;
};

Finding about(const Subject& subject, Severity severity, const char* code, std::string message) {
  return {subject.file, 0, severity, code, std::move(message)};
}

Choice choose_log_linear(const Subject& subject, const SubjectOptions& options,
                         const SteadyFit& line) {
  return {line,
          {subject.points, Family::kPower, ErrorModel::kLogForce, options.loss, subject.beta_range},
          "log-linear",
          0,
          {}};
}

/// The finding `families-not-compared`: too few rows for a comparison, so the fit uses the power
/// law.
Finding not_compared(const Subject& subject) {
  return about(
      subject, Severity::kWarning, "families-not-compared",
      fmt::format("the {} resistance has {} rows, but a comparison of resistance families by "
                  "AICc needs {} rows, so the fit uses the power law. Record {} more rows",
                  name_in(kFitSubjectNames, subject.name), subject.points.size(), kMinToCompare,
                  kMinToCompare - subject.points.size()));
}

/// Error finding if no family can be chosen. `tried`: true if the family is selected by AICc and at
/// least one family was fitted.
Finding nothing_to_choose(const Subject& subject, bool tried) {
  if (!tried) {
    return about(
        subject, Severity::kError, "too-few-rows",
        fmt::format("{} rows are too few for the requested resistance family; record more runs, or "
                    "request the power law",
                    subject.points.size()));
  }
  return about(subject, Severity::kError, "not-converged",
               fmt::format("no resistance family has a {} fit that converged and can be "
                           "compared with other families. The comparison (by AICc) needs at "
                           "least three runs more than the family has parameters; record more "
                           "runs",
                           name_in(kFitSubjectNames, subject.name)));
}

/// Selects the requested family, or the family with the smallest AICc, under the error model
/// `wanted`.
Choice choose_nonlinear(const Subject& subject, const SubjectOptions& options, ErrorModel wanted,
                        const std::vector<FamilyCandidate>& candidates) {
  Choice choice;
  const FamilyCandidate* chosen = options.family.family
                                      ? candidate_of(candidates, *options.family.family, wanted)
                                      : best_candidate(candidates, wanted);
  const bool tried = std::ranges::any_of(
      candidates, [&](const FamilyCandidate& c) { return c.problem.noise == wanted; });
  if (!chosen && !options.family.family && subject.points.size() < kMinToCompare) {
    // If there are so few runs, no family has an AICc. The power law has as few parameters as any
    // other family.
    chosen = candidate_of(candidates, Family::kPower, wanted);
    choice.findings.push_back(not_compared(subject));
  }
  if (!chosen) {
    choice.findings.push_back(nothing_to_choose(subject, tried && !options.family.family));
    return choice;
  }
  choice.method = method_in_words(chosen->problem);
  if (!chosen->fit.usable) {
    choice.findings.push_back(
        about(subject, Severity::kError, "not-converged",
              fmt::format("the {} fit of {} did not converge: {}", choice.method,
                          name_in(kFitSubjectNames, subject.name), chosen->fit.stop_reason)));
    return choice;
  }
  if (chosen->fit.held_by_bound(TransformedParameter::kBeta)) {
    choice.findings.push_back(held_exponent(subject, chosen->fit));
    return choice;
  }
  choice.fit = chosen->fit;
  choice.problem = chosen->problem;
  choice.report = 1 + at(chosen - candidates.data());
  return choice;
}

/// The finding `power-law-inadequate`, if the AICc of another family is lower than that of the
/// power law by at least kTablesPlainlyBetter. No finding if the user chose another family.
std::vector<Finding> power_law_findings(const Subject& subject, ErrorModel wanted,
                                        const std::vector<FamilyCandidate>& candidates,
                                        Family used) {
  const FamilyCandidate* power = candidate_of(candidates, Family::kPower, wanted);
  const FamilyCandidate* best = best_candidate(candidates, wanted);
  if (!power || !best || !aicc(power->fit) || best->problem.family == Family::kPower) return {};
  const double difference = *aicc(power->fit) - *aicc(best->fit);
  if (difference < kTablesPlainlyBetter) return {};
  const bool power_used = used == Family::kPower;
  const std::string_view better = name_of(best->problem.family);
  const std::string option =
      fmt::format("family {}={}", name_in(kFitSubjectNames, subject.name), better);
  return {about(subject, power_used ? Severity::kWarning : Severity::kNote, "power-law-inadequate",
                fmt::format("a power law does not describe these runs. The family {} fits better: "
                            "its AICc (a measure of the error) is lower by {}, its residual "
                            "standard deviation is {:.3g} (power law: {:.3g}){}",
                            better, aic_decrease_text(difference, 1), best->fit.residual_std,
                            power->fit.residual_std,
                            power_used ? ". The values that follow from these runs get no "
                                         "intervals; use " +
                                             option_text(option)
                                       : std::string()))};
}

/// Adds residual tests and leave-one-out fits to the chosen report, and their findings.
void add_diagnostics(const Subject& subject, std::size_t report, SubjectFit& result) {
  const SteadyFit& fit = *result.chosen;
  EstimatorReport& chosen = result.reports[report];
  if (fit.degrees_of_freedom >= 1) {
    chosen.diagnostics = residual_tests(subject, fit);
    append(result.findings, outlier_findings(subject, result.problem, fit));
  }
  if (fit.degrees_of_freedom >= 2) {
    Influence influence = leave_one_out(subject, result.problem, result.log_linear, fit);
    chosen.leave_one_out = std::move(influence.without);
    append(result.findings, influence.findings);
    if (rows_of(subject.points) > kExactRows) {
      chosen.stop_reason += chosen.leave_one_out.empty()
                                ? "; without leave-one-out fits, because of the robust loss and "
                                  "the number of rows"
                                : "; leave-one-out fits approximated by one step from the fit of "
                                  "all rows";
    }
  }
}

/// Error finding if no fit is possible: the log-linear fit failed, or `--noise time` was requested
/// and a row has no time.
std::optional<Finding> obstacle(const Subject& subject, const SubjectOptions& options,
                                ErrorModel wanted, const SteadyFit& line) {
  if (!line.usable) {
    return about(
        subject, Severity::kError, "not-converged",
        fmt::format("the log-linear fit of the {} resistance gives no curve ({}); check the rows",
                    name_in(kFitSubjectNames, subject.name), line.stop_reason));
  }
  const bool by_time = options.method != Method::kLogLinear && wanted == ErrorModel::kTime;
  if (by_time && !all_timed(subject.points)) {
    return about(subject, Severity::kError, "not-timed",
                 fmt::format("{} needs distance_m (or turns) and elapsed_s in every row; add them, "
                             "or remove the option",
                             option_text("noise time")));
  }
  return std::nullopt;
}

void take(const Subject& subject, Choice choice, SubjectFit& result) {
  result.method = std::move(choice.method);
  if (!choice.fit) result.refusal_reason = choice.findings.back().message;
  append(result.findings, choice.findings);
  if (!choice.fit) return;
  result.chosen = std::move(choice.fit);
  result.problem = std::move(choice.problem);
  append(result.findings, bound_findings(subject, *result.chosen, result.problem.family));
}

/// Removes the gross outliers from the subject. Returns a finding for each.
std::vector<Finding> set_outliers_aside(Subject& subject, const SubjectOptions& options) {
  constexpr std::size_t kOneIn = 10;
  std::vector<Finding> findings;
  if (options.keeps_outliers || options.loss != Loss::kSquared) return findings;
  const std::size_t most = std::max<std::size_t>(1, subject.points.size() / kOneIn);
  while (findings.size() < most) {
    const auto outlier = gross_outlier(subject, options);
    if (!outlier) break;
    findings.push_back(set_aside(subject, *outlier));
    subject.points.erase(subject.points.begin() + eigen_index(outlier->point));
  }
  return findings;
}

/// Writes the probability of each error model into the report of its fit, if there is one.
void put_weights(std::size_t chosen_report, SubjectFit& result) {
  if (result.alternatives.size() < 2) return;
  const std::string family(name_of(result.problem.family));
  result.reports[chosen_report].weight = result.alternatives.front().weight;
  for (std::size_t k = 1; k < result.alternatives.size(); ++k) {
    const std::string_view noise = name_of(result.alternatives[k].noise);
    const auto report = std::ranges::find_if(result.reports, [&](const EstimatorReport& r) {
      return r.noise == noise && r.family == family;
    });
    if (report != result.reports.end()) report->weight = result.alternatives[k].weight;
  }
}

/// The fits of SubjectFit::undecided, for the chosen family `used`.
std::vector<FamilyCandidate> undecided_fits(const std::vector<FamilyCandidate>& candidates,
                                            ErrorModel wanted, Family used) {
  const FamilyCandidate* chosen = candidate_of(candidates, used, wanted);
  if (!chosen || !chosen->fit.usable || !aicc(chosen->fit)) return {};
  std::vector<FamilyCandidate> fits{*chosen};
  for (const FamilyCandidate& other : candidates) {
    if (&other == chosen || other.problem.noise != wanted || !other.fit.usable) continue;
    const auto score = aicc(other.fit);
    if (score && *score < *aicc(chosen->fit) + kTablesPlainlyBetter) fits.push_back(other);
  }
  return fits;
}

/// Compares the chosen family with the others: sets the findings about the power law,
/// `is_inadequate`, `undecided` and `compared` of `result`.
void compare_families(const Subject& subject, const SubjectOptions& options, ErrorModel wanted,
                      const std::vector<FamilyCandidate>& candidates, SubjectFit& result) {
  const Family chosen = result.problem.family;
  if (options.family.family.value_or(Family::kPower) == Family::kPower) {
    const auto findings = power_law_findings(subject, wanted, candidates, chosen);
    result.is_inadequate = !findings.empty() && chosen == Family::kPower;
    append(result.findings, findings);
  }
  result.undecided = undecided_fits(candidates, wanted, chosen);
  const ErrorModel likeliest =
      std::ranges::max_element(result.alternatives, {}, &NoiseAlternative::weight)->noise;
  result.compared = fit_families(subject, likeliest, chosen);
}

SubjectFit fit_rows(const Subject& subject, const SubjectOptions& options) {
  SubjectFit result;
  if (!has_two_forces(subject.points)) return result;
  const SteadyFit line = fit_log_linear(subject.points);
  if (line.rank < 2) return result;
  if (line.usable) {
    result.reports.push_back(report_of(subject, line, Family::kPower, Estimator::kLogLinear,
                                       name_of(ErrorModel::kLogForce)));
  }
  const ErrorModel wanted = wanted_noise(subject, options);
  result.log_linear = options.method == Method::kLogLinear;
  if (auto finding = obstacle(subject, options, wanted, line)) {
    result.refusal_reason = finding->message;
    result.findings.push_back(*std::move(finding));
    return result;
  }
  const std::vector<FamilyCandidate> candidates = fit_candidates(subject, options, wanted, line);
  for (const FamilyCandidate& candidate : candidates) result.reports.push_back(candidate.report);
  Choice choice = result.log_linear ? choose_log_linear(subject, options, line)
                                    : choose_nonlinear(subject, options, wanted, candidates);
  const std::size_t report = choice.report;
  take(subject, std::move(choice), result);
  if (!result.chosen) return result;
  result.alternatives =
      noise_alternatives(subject, options, result.problem, *result.chosen, candidates);
  put_weights(report, result);
  if (!options.side_by_side) return result;
  add_diagnostics(subject, report, result);
  if (options.loss == Loss::kSquared) {
    compare_families(subject, options, wanted, candidates, result);
  }
  return result;
}

}  // namespace

SubjectFit fit_subject(Subject subject, const SubjectOptions& options) {
  if (!has_two_forces(subject.points)) return {};
  std::vector<Finding> aside = set_outliers_aside(subject, options);
  SubjectFit result = fit_rows(subject, options);
  append(result.findings, aside);
  return result;
}

}  // namespace awmr
