#include "awmr/identify/logs/choice/changes_between_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/logs/choice/back_emf.h"
#include "awmr/identify/logs/choice/further_terms.h"
#include "awmr/identify/logs/choice/model_choice.h"
#include "awmr/identify/logs/log_setup.h"
#include "awmr/identify/logs/problem/information.h"
#include "awmr/identify/logs/problem/score_test.h"
#include "awmr/identify/logs/problem/uncertain_changes.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Decrease of AIC above which unknown times of the changes are used. It is smaller than the
/// threshold of the families: if the commands do change at their rows, unknown times make the
/// intervals wider, but not wrong.
constexpr double kLikelier = 6.0;

Finding changes_between_rows_finding(const std::string& file) {
  return {file, 0, Severity::kNote, "changes-between-rows",
          "the commands change between the rows, and the log shows only samples of them; the fit "
          "treats the time of each change as unknown within one row spacing. Log every command "
          "when it is sent"};
}

/// -2 ln L of a fit near a point x, as a function of steps d of its coordinates. The optimal
/// initial states of the windows are already inserted:
///
///     -2 ln L(x + d) = constant + 2 S^T d + d^T (H + prior) d        (H, S: FitEvidence)
struct Quadratic {
  FitEvidence evidence;  ///< H + prior, S
  double constant = 0.0;
};

/// `prior`: information of the weak prior of each coordinate.
Quadratic quadratic(const std::vector<WindowSums>& sums, const Eigen::VectorXd& prior) {
  const Eigen::Index n = prior.size();
  Quadratic result{fit_evidence(sums, n), 0.0};
  result.evidence.information.diagonal() += prior;
  for (const WindowSums& window : sums) {
    const Eigen::Index k = window.products.rows() - 1 - n;
    const Eigen::VectorXd gradient = window.products.block(n, n + k, k, 1);
    result.constant +=
        window.products(n + k, n + k) -
        gradient.dot(Eigen::VectorXd(solve_ldlt(window.products.block(n, n, k, k), gradient)));
  }
  return result;
}

/// The indices 0 to `count` - 1.
std::vector<Eigen::Index> first_indices(std::size_t count) {
  std::vector<Eigen::Index> indices(count);
  std::iota(indices.begin(), indices.end(), Eigen::Index{0});
  return indices;
}

/// Minimum of a Quadratic over some of the coordinates. The others do not change.
struct Minimum {
  double aic;            ///< -2 ln L at the minimum, plus 2 for each free coordinate
  Eigen::VectorXd step;  ///< step of every coordinate
};

Minimum minimum(const Quadratic& of, const std::vector<Eigen::Index>& free) {
  const Eigen::VectorXd score = of.evidence.score(free);
  const Eigen::VectorXd change = -solve_ldlt(of.evidence.information(free, free), score);
  Minimum result{.aic = of.constant + score.dot(change) + 2.0 * static_cast<double>(free.size()),
                 .step = Eigen::VectorXd::Zero(of.evidence.score.size())};
  result.step(free) = change;
  return result;
}

/// True if each of the coordinates `added`, which start at 0, has a possible value after the step.
bool are_possible(const Minimum& minimum, std::span<const Eigen::Index> added,
                  const std::vector<FreeQuantity>& quantities) {
  return std::ranges::all_of(added, [&](Eigen::Index i) {
    const FreeQuantity& q = quantities[at(i)];
    const bool is_positive = q.may_be_zero() || q.kind == FreeQuantity::Kind::kParameter;
    return !is_positive || minimum.step(i) > 0.0;
  });
}

/// Minimum over the first `always` coordinates and those of the others that lower AIC by more than
/// kTermAicThreshold, added one after the other, the best first.
Minimum minimum_with_terms(const Quadratic& of, const std::vector<FreeQuantity>& quantities,
                           std::size_t always) {
  std::vector<Eigen::Index> free = first_indices(always);
  Minimum best = minimum(of, free);
  while (true) {
    std::optional<Minimum> better;
    Eigen::Index added = 0;
    for (std::size_t i = always; i < quantities.size(); ++i) {
      const Eigen::Index candidate = eigen_index(i);
      if (contains(free, candidate)) continue;
      free.push_back(candidate);
      Minimum with = minimum(of, free);
      const bool is_possible = are_possible(with, std::span(free).subspan(always), quantities);
      free.pop_back();
      if (!is_possible) continue;
      if (!(with.aic < (better ? better->aic : best.aic - kTermAicThreshold))) continue;
      better = std::move(with);
      added = candidate;
    }
    if (!better) return best;
    best = *std::move(better);
    free.push_back(added);
  }
}

/// Times of the changes after the step `step` of the coordinates (WindowErrors::change_times).
std::vector<double> change_times_after(const std::vector<WindowSums>& sums,
                                       const Eigen::VectorXd& step) {
  const Eigen::Index n = step.size();
  std::vector<double> times;
  for (const WindowSums& window : sums) {
    if (window.change_times.size() == 0) continue;
    const Eigen::Index k = window.products.rows() - 1 - n;
    const Eigen::VectorXd gradient =
        window.products.block(n, n + k, k, 1) + window.products.block(n, 0, k, n) * step;
    // Steps of the coordinates and of the initial state, then -1. This -1 multiplies the last
    // column of WindowSums::change_times, the times before the step.
    Eigen::VectorXd all(n + k + 1);
    all << step, -solve_ldlt(window.products.block(n, n, k, k), gradient), -1.0;
    append(times, Eigen::VectorXd(-window.change_times * all));
  }
  return times;
}

struct UncertainTimes {
  /// Decrease of AIC if the times of the changes are uncertain; 0 if no command changes.
  double lead = 0.0;
  /// WindowErrors::change_times at the minimum over all coordinates.
  std::vector<double> standardised;
};

/// Compares uncertain times of the changes with changes at the rows. In both cases, the quantities
/// of the problem and `always` are free, and those of `optional` that lower AIC
/// (minimum_with_terms()).
UncertainTimes uncertain_times(const LogProblem& problem, const SearchPoint& point,
                               const std::vector<FreeQuantity>& always,
                               const std::vector<FreeQuantity>& optional) {
  std::vector<FreeQuantity> more = always;
  append(more, optional);
  Extended with =
      extended(with_white_noise(problem), point, more, std::vector<double>(more.size(), 0.0));
  const std::size_t n_always = problem.model.quantities.size() + always.size();
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
  const Quadratic between = quadratic(sums, prior);
  const std::vector<double> times =
      change_times_after(sums, minimum(between, first_indices(quantities.size())).step);
  double lead = -minimum_with_terms(between, quantities, n_always).aic;
  for (WindowSums& window : sums) {
    lead -= window.change_cost;
    if (window.products_at_known_times.size() == 0) continue;
    window.products = window.products_at_known_times;
  }
  lead += minimum_with_terms(quadratic(sums, prior), quantities, n_always).aic;
  return {lead, times};
}

/// Options of a fit with unknown times of the changes. The fit begins at the stopped fit `at_rows`,
/// with its back-EMF, and with its motor lag if that is above `step_s`, the row spacing. Wrong
/// times of the changes can cause delays and shorter lags, so those of `at_rows` are left out. The
/// terms of its families begin at the values of `power_law`.
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
  const auto lag_s = at_rows.fit.value_of(FreeQuantity::Kind::kMotorLag);
  if (!lag_s || !(*lag_s > step_s)) return from;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const FreeQuantity::Kind kind = quantities[i].kind;
    const bool is_requested = std::ranges::any_of(
        from.terms, [&](const FreeTerm& term) { return term.quantity.kind == kind; });
    const bool is_of_lag =
        kind == FreeQuantity::Kind::kMotorLag || kind == FreeQuantity::Kind::kRunOn;
    if (!is_of_lag || is_requested) continue;
    from.terms.push_back({quantities[i], at_rows.fit.coordinates[i]});
  }
  return from;
}

/// Adds averaging of speed and yaw rate over one row, unless a filter of the channel is a term.
LogFitOptions with_averaged_rows(LogFitOptions options, const std::vector<DrivingLog>& logs) {
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    const FreeQuantity averaging = free_term(FreeQuantity::Kind::kAveraging, channel);
    const bool has_other = std::ranges::any_of(options.terms, [&](const FreeTerm& term) {
      return term.quantity.name() == averaging.name() ||
             term.quantity.name() == sensor_lag_of(channel).name();
    });
    if (!is_logged(logs, {channel}) || has_other) continue;
    options.terms.push_back({averaging, logs.front().median_step_s()});
  }
  return options;
}

/// Fits the logs with changes at the rows, and the families and terms of `between`, a fit with
/// unknown times of the changes: with averaging too and without it. The speed of an encoder is the
/// mean since the row before, so it responds to a change at a row as if the change were between the
/// rows.
std::vector<FamilyFit> fits_at_rows(const FamilyFit& between, const std::vector<DrivingLog>& logs,
                                    const LogFitOptions& power_law) {
  const LogFitOptions same = from_optimum(with_back_emf_as_in(between, power_law), between);
  const LogFitOptions averaged = with_averaged_rows(same, logs);
  std::vector<FamilyFit> fits{fit_family(logs, same, between.surge, between.yaw)};
  if (averaged.terms.size() > same.terms.size()) {
    fits.push_back(fit_family(logs, averaged, between.surge, between.yaw));
  }
  return fits;
}

}  // namespace

bool has_changes_between_rows(const LogProblem& problem, const SearchPoint& point,
                              const std::vector<ParameterId>& candidate_terms) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  std::vector<FreeQuantity> delays;
  for (const auto kind : {FreeQuantity::Kind::kDelay, FreeQuantity::Kind::kSteeringDelay}) {
    if (!has(quantities, kind)) delays.push_back(free_term(kind));
  }
  // A quick test first.
  if (!(uncertain_times(problem, point, delays, {}).lead > kLikelier)) return false;
  std::vector<FreeQuantity> optional = further_terms(problem);
  std::erase_if(optional, [&](const FreeQuantity& q) {
    return q.is_ramp() || has(delays, q.kind) || q.kind == FreeQuantity::Kind::kParameter;
  });
  for (const ParameterId term : candidate_terms) {
    if (!place_of(quantities, term)) optional.push_back(free_parameter(term));
  }
  const UncertainTimes times = uncertain_times(problem, point, delays, optional);
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
  // The fit with unknown times may use half of the remaining work (Effort). If this fit is
  // rejected, the rest is enough for the fits that follow.
  constexpr std::int64_t kEffortShare = 2;
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
  between.fit = fit_first_family(between.logs, from, options, {at_rows.surge, at_rows.yaw});
  std::vector<FamilyFit> others = fits_at_rows(between.fit, logs, power_law);
  between.fit.options.effort = power_law.effort;
  const bool is_usable =
      std::ranges::all_of(others, [](const auto& one) { return one.fit.usable; });
  const FamilyFit& other = *std::ranges::max_element(
      others, [](const FamilyFit& a, const FamilyFit& b) { return aic_lead(b.fit, a.fit) > 0.0; });
  if (!from.effort->is_over() && between.fit.fit.usable && is_usable &&
      are_times_between_rows(between.fit.fit.change_times) &&
      aic_lead(between.fit.fit, other.fit) > kLikelier) {
    between.findings.push_back(changes_between_rows_finding(logs.front().file));
    return between;
  }
  if (!is_usable) return {logs, fit_first_family(logs, power_law, options), {}};
  return {logs,
          with_new_terms(logs, with_optional_coulomb(power_law, options, other.surge, other.yaw),
                         other),
          {}};
}

}  // namespace awmr
