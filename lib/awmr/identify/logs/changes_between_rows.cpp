#include "awmr/identify/logs/changes_between_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/linear_algebra.h"
#include "awmr/identify/logs/back_emf.h"
#include "awmr/identify/logs/further_terms.h"
#include "awmr/identify/logs/information.h"
#include "awmr/identify/logs/model_choice.h"
#include "awmr/identify/logs/score_test.h"
#include "awmr/identify/logs/uncertain_changes.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

Finding changes_between_rows_finding(const std::string& file) {
  return {file, 0, Severity::kNote, "changes-between-rows",
          "the commands change between the rows, and the log shows only samples of them; the fit "
          "treats the time of each change as unknown within one row spacing. Log every command "
          "when it is sent"};
}

/// Result that one Gauss-Newton step of all coordinates and initial states predicts: the cost, and
/// the times at which commands change.
struct Predicted {
  double squares = 0.0;              ///< twice the predicted cost
  std::vector<double> change_times;  ///< WindowErrors::change_times
};

/// Predicts the result of a Gauss-Newton step from the sums of all windows. `prior`: information of
/// the weak prior of each coordinate.
Predicted predicted(const std::vector<WindowSums>& sums, const Eigen::VectorXd& prior) {
  const Eigen::Index n = prior.size();
  const FitEvidence evidence = fit_evidence(sums, n);
  Eigen::MatrixXd information = evidence.information;
  information.diagonal() += prior;
  const Eigen::VectorXd change = -solve_ldlt(information, evidence.score);
  Predicted result{.squares = evidence.score.dot(change), .change_times = {}};
  for (const WindowSums& window : sums) {
    const Eigen::Index k = window.products.rows() - 1 - n;
    const Eigen::MatrixXd of_initial = window.products.block(n, n, k, k);
    const Eigen::VectorXd gradient = window.products.block(n, n + k, k, 1);
    result.squares += window.products(n + k, n + k) -
                      gradient.dot(Eigen::VectorXd(solve_ldlt(of_initial, gradient)));
    if (window.change_times.size() == 0) continue;
    // Steps of the coordinates and of the initial state, then -1. This -1 multiplies the last
    // column of WindowSums::change_times, the times before the step.
    Eigen::VectorXd all(n + k + 1);
    all << change, -solve_ldlt(of_initial, gradient + window.products.block(n, 0, k, n) * change),
        -1.0;
    const Eigen::VectorXd times = -window.change_times * all;
    append(result.change_times, times);
  }
  return result;
}

struct UncertainTimes {
  /// Decrease of -2 ln L if the times of the changes are uncertain; 0 if no command changes.
  double lead = 0.0;
  std::vector<double> standardised;  ///< WindowErrors::change_times
};

/// Compares uncertain times of the changes with changes at the rows. `more`: free quantities in
/// addition to those of the problem.
UncertainTimes uncertain_times(const LogProblem& problem, const SearchPoint& point,
                               const std::vector<FreeQuantity>& more) {
  Extended with =
      extended(with_white_noise(problem), point, more, std::vector<double>(more.size(), 0.0));
  bool any = false;
  for (FitWindow& window : with.problem.windows) {
    if (window.changes.empty()) window.changes = changes_before_rows(window.rows);
    any = any || !window.changes.empty();
  }
  if (!any) return {};
  std::vector<WindowSums> sums = sums_at(with.problem, with.point);
  if (!all_finite(sums)) return {};
  const std::vector<FreeQuantity>& quantities = with.problem.model.quantities;
  Eigen::VectorXd prior(rows_of(quantities));
  for (Eigen::Index i = 0; i < prior.size(); ++i) {
    const double std = kPriorStd * quantities[at(i)].large_change;
    prior(i) = 1.0 / (std * std);
  }
  const Predicted between = predicted(sums, prior);
  double lead = -between.squares;
  for (WindowSums& window : sums) {
    lead -= window.change_cost;
    if (window.products_at_known_times.size() == 0) continue;
    window.products = window.products_at_known_times;
    window.change_times.resize(0, 0);
  }
  lead += predicted(sums, prior).squares;
  return {lead, between.change_times};
}

/// Options of a fit with unknown times of the changes. The fit begins at the stopped fit `at_rows`,
/// with its back-EMF, and with its motor lag if that is above `step_s`, the row spacing. Wrong
/// times of the changes can cause delays and shorter lags, so those of `at_rows` are left out. The
/// terms of its families are left out, too: the new fit begins with the families of `power_law`.
LogFitOptions options_from(const FamilyFit& at_rows, const LogFitOptions& power_law,
                           double step_s) {
  LogFitOptions from = with_back_emf_as_in(at_rows, power_law);
  from.initial_guess = fitted_values(at_rows.options, at_rows.fit);
  from.guessed.clear();
  reset_terms(from.free, power_law.initial_guess, from.initial_guess);
  // If the assumed times of the changes are wrong, the fitted time constant of the servo can be
  // almost 0. A search that begins there would stay there.
  constexpr std::size_t kServo = at(ParameterId::kSteeringTimeConstant);
  from.initial_guess[kServo] = power_law.initial_guess[kServo];
  const std::vector<FreeQuantity>& quantities = at_rows.fit.quantities;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const bool is_requested = std::ranges::any_of(
        from.terms, [&](const FreeTerm& term) { return term.quantity.kind == quantities[i].kind; });
    if (quantities[i].kind != FreeQuantity::Kind::kMotorLag || is_requested) continue;
    const double coordinate = at_rows.fit.coordinates[i];
    if (quantities[i].value(coordinate) > step_s) from.terms.push_back({quantities[i], coordinate});
  }
  return from;
}

}  // namespace

bool has_changes_between_rows(const LogProblem& problem, const SearchPoint& point,
                              const std::vector<ParameterId>& candidate_terms) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  std::vector<FreeQuantity> delays;  // a quick test first
  for (const auto kind : {FreeQuantity::Kind::kDelay, FreeQuantity::Kind::kSteeringDelay}) {
    if (!has(quantities, kind)) delays.push_back(free_term(kind));
  }
  constexpr double kClearly = 20.0;
  if (!(uncertain_times(problem, point, delays).lead > kClearly)) return false;
  std::vector<FreeQuantity> more = further_terms(problem);
  std::erase_if(more, [](const FreeQuantity& q) { return q.is_ramp(); });
  for (const ParameterId term : candidate_terms) {
    if (!place_of(quantities, term)) more.push_back(free_parameter(term));
  }
  const UncertainTimes times = uncertain_times(problem, point, more);
  return times.lead > 0.0 && are_times_between_rows(times.standardised);
}

bool are_times_between_rows(const std::vector<double>& times) {
  // Variance of x^2 if x is uniform with the mean 0 and the variance 1, like the time of a change
  // between two rows.
  constexpr double kVariance = 0.8;
  // Accepted excess of the mean square over 1, in its standard errors.
  constexpr double kErrors = 2.0;
  double squares = 0.0;
  for (const double time : times) squares += time * time;
  const auto n = static_cast<double>(times.size());
  return squares / n < 1.0 + kErrors * std::sqrt(kVariance / n);
}

FirstFit first_fit(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const IdentifyOptions& options) {
  // The fit with unknown times may use a third of the remaining work (Effort). If this fit is
  // rejected, the rest is enough for the fits that follow.
  constexpr std::int64_t kEffortShare = 3;
  LogFitOptions tests = power_law;
  tests.tests_changes = std::ranges::none_of(logs, [](const DrivingLog& log) {
    return log.has_interpolated_commands || log.has_held_set_points;
  });
  FamilyFit at_rows = fit_first_family(logs, tests, options);
  at_rows.options.tests_changes = false;
  if (!at_rows.fit.has_changes_between_rows) return {logs, std::move(at_rows), {}};
  FirstFit between{with_changes_between_rows(logs), {}, {}};
  LogFitOptions from = options_from(at_rows, power_law, logs.front().median_step_s());
  from.effort = std::make_shared<Effort>(power_law.effort->left() / kEffortShare);
  between.fit = fit_first_family(between.logs, from, options);
  at_rows = fit_family(logs, from_optimum(with_back_emf_as_in(between.fit, power_law), between.fit),
                       between.fit.surge, between.fit.yaw);
  between.fit.options.effort = power_law.effort;
  if (!from.effort->is_over() && between.fit.fit.usable &&
      are_times_between_rows(between.fit.fit.change_times) &&
      aic_lead(between.fit.fit, at_rows.fit) > kFamilyAicThreshold) {
    between.findings.push_back(changes_between_rows_finding(logs.front().file));
    return between;
  }
  return {logs, fit_first_family(logs, power_law, options), {}};
}

}  // namespace awmr
