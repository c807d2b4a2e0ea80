#include "awmr/identify/coastdown/coast_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/identify/coastdown/coast_noise.h"
#include "awmr/identify/coastdown/derived.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Two models describe the curves about equally well if their AICc differ by less than this. A
/// difference of 10 is a likelihood ratio of 150. If this threshold is larger, more intervals of m'
/// are withdrawn.
constexpr double kClose = 10.0;

struct CoastData {
  const std::vector<CoastCurve>& curves;
  const SteadyFit& surge;
  double sensor_mps = 0.0;  ///< standard deviation of the readings' white noise
};

/// A model of the curves, with or without a filter in the speed sensor, and its best parameters.
struct CoastCandidate {
  CoastStart at;
  ChannelNoise noise;
  double aicc = std::numeric_limits<double>::infinity();
  Eigen::VectorXd residuals;  ///< m/s, curve after curve
  /// CoastProblem::law_distance() plus 2 for each free parameter of the curves.
  double penalty = 0.0;
};

/// Standard deviation of the speed noise, m/s: the root mean square of the curves' noise_of(), over
/// all rows.
double pooled_noise(const std::vector<CoastCurve>& curves) {
  double squares = 0.0;
  double rows = 0.0;
  for (const CoastCurve& curve : curves) {
    const auto n = static_cast<double>(curve.t_s.size());
    squares += n * std::pow(noise_of(curve), 2);
    rows += n;
  }
  return std::sqrt(squares / rows);
}

/// Lets the fit vary the surge law: its coordinates become free parameters, with the covariance of
/// the surge fit as prior. The dead zone stays fixed, because it has no effect in a coast-down.
/// Does nothing if the surge fit has no covariance or `prior_mps` is 0. `prior_mps`: standard
/// deviation of the curves' noise, m/s, which weights the prior against the curves.
void free_within_errors(const CoastData& data, double prior_mps, CoastProblem& problem) {
  if (!data.surge.has_covariance() || !(prior_mps > 0.0)) return;
  std::vector<TransformedParameter> free;
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < data.surge.free.size(); ++i) {
    if (data.surge.free[i] == TransformedParameter::kDeadZone) continue;
    free.push_back(data.surge.free[i]);
    places.push_back(eigen_index(i));
  }
  problem.free_law(free, data.surge.covariance(places, places), prior_mps);
}

/// Fits the curves once, with a filter if `start` has one. `prior_mps`: see free_within_errors();
/// 0: the surge law is fixed.
CoastCandidate fit_once(const CoastData& data, const CoastStart& start, double prior_mps) {
  const Resistance<double> law = data.surge.law();
  CoastProblem problem(data.curves, data.surge.theta, start,
                       law.coulomb > 0.0 || law.quadratic > 0.0);
  free_within_errors(data, prior_mps, problem);
  problem.solve();
  CoastCandidate fit{.at = {*problem.log_mass(), *problem.lag_s()}, .noise = {}, .residuals = {}};
  const std::optional<Eigen::VectorXd> e = problem.residuals();
  if (!e || !problem.summary().IsSolutionUsable()) return fit;
  const auto n = static_cast<double>(e->size());
  if (n <= problem.free_count()) return fit;
  fit.noise = noise_of_residuals(*e, data.curves, problem.free_count(), data.sensor_mps);
  const double k = problem.free_count() + fit.noise.numbers();
  if (n <= k + 1.0) return fit;
  fit.residuals = *e;
  fit.penalty = problem.law_distance() + 2.0 * problem.free_count();
  fit.aicc =
      fit.noise.cost + problem.law_distance() + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
  return fit;
}

/// Fits the curves while the surge law may vary within its covariance. How far the law moves
/// depends on the noise of the curves, which is unknown. The first round therefore assumes the
/// noise of the readings, and each further round the noise of the last residuals. Returns the fit
/// with the smallest AICc.
CoastCandidate fit_candidate(const CoastData& data, const CoastStart& start) {
  constexpr int kRounds = 4;
  constexpr double kSame = 0.3;
  CoastCandidate best;
  double prior_mps = pooled_noise(data.curves);
  for (int round = 0; round < kRounds; ++round) {
    const CoastCandidate fit = fit_once(data, start, prior_mps);
    if (round == 0 || fit.aicc < best.aicc) best = fit;
    const double std = effective_std(fit.noise, data.curves);
    if (!(std::abs(std / prior_mps - 1.0) > kSame)) break;
    prior_mps = std;
  }
  return best;
}

/// Time constant of the speed sensor's filter at the start of the search, divided by the time
/// constant of the vehicle's deceleration.
constexpr double kFast = 0.2;

/// Returns an initial guess for a fit with a filter in the speed sensor, from `plain`, the fit
/// without one. The guess has a fast filter and a smaller mass m' than `plain`, because the filter
/// explains a part of the slow decrease of the logged speed.
CoastStart fast_filter(const CoastData& data, const CoastStart& plain) {
  return {plain.log_mass + std::log1p(-kFast),
          kFast * fall_time_s(data.curves, data.surge.law(), plain.log_mass)};
}

/// Fits the curves with a filter in the speed sensor, from two initial guesses. The first guess has
/// a fast filter. The second guess is the optimum of the first fit with two time constants
/// exchanged, that of the filter and that of the deceleration, because both optima may describe the
/// curves. Returns both fits, the one with the lower AICc first.
std::vector<CoastCandidate> fit_filters(const CoastData& data, const CoastStart& plain) {
  CoastCandidate fast = fit_candidate(data, fast_filter(data, plain));
  const double found_s = fall_time_s(data.curves, data.surge.law(), fast.at.log_mass);
  const double ratio = std::max(kFast, fast.at.lag_s / found_s);
  CoastCandidate slow = fit_candidate(data, {fast.at.log_mass + std::log(ratio), found_s});
  if (slow.aicc < fast.aicc) return {slow, fast};
  return {fast, slow};
}

bool is_slow(const CoastStart& at, const CoastData& data) {
  return at.lag_s > fall_time_s(data.curves, data.surge.law(), at.log_mass);
}

/// Returns another m' and another filter of the speed sensor that describe the curves nearly as
/// well as those of the reported fit; empty if there are none. `plain` is the fit without a filter.
/// `best` and `other` are the fits with a filter from two initial guesses; in these three fits, the
/// surge law may vary. `fixed` is the reported fit: it started at `best`, with the surge law fixed.
/// The first of these candidates that applies is returned:
///   - `other`, if its AICc is less than kClose above that of `best`, its m' differs, and tyres can
///     give its deceleration;
///   - `plain`, if the filter of `best` is slower than the motion and the residuals are correlated;
///   - `best`, if `fixed` has another m', and the filter is slower than the motion in only one of
///     these two fits;
///   - the point found by flat_direction(), where the sum of squares is lower than the standard
///     error of ln m' predicts.
std::optional<CoastStart> competitor(const CoastCandidate& plain, const CoastCandidate& other,
                                     const CoastCandidate& best, const CoastFit& fixed,
                                     const CoastData& data) {
  constexpr double kDifferent = 0.1;  // smallest difference of ln m' that counts as another m'
  const auto differs = [&](const CoastStart& at) {
    return std::abs(at.log_mass - best.at.log_mass) > kDifferent;
  };
  if (other.aicc < best.aicc + kClose && differs(other.at) &&
      !is_implausible(data.surge.law(), highest_speed_mps(data.curves),
                      std::exp(other.at.log_mass))) {
    return other.at;
  }
  const bool slow = is_slow(best.at, data);
  if (slow && best.noise.drift_std > 0.0) return plain.at;
  const CoastStart given{fixed.log_mass_norm, fixed.lag->value_s};
  if (differs(given) && is_slow(given, data) != slow) return best.at;
  return flat_direction(data.curves, data.surge, fixed);
}

/// ChannelNoise::longest_filter_s of the curves: 0.5 s, or the time constant of the motion if that
/// is shorter.
double longest_drift_s(const CoastData& data, const CoastStart& at) {
  return std::min(ChannelNoise{}.longest_filter_s,
                  fall_time_s(data.curves, data.surge.law(), at.log_mass));
}

/// Fits the curves with a low-pass filter in the speed sensor: the logged speed y follows the true
/// speed u by T y' = u - y. Adds the filter to `model` if this fit is significantly better than
/// `plain`, the fit without a filter.
void add_filter(const CoastData& data, const CoastCandidate& plain, CoastModel& model) {
  // The filter must lower AICc by more than this. With a smaller limit, the fit would more often
  // explain noise by a filter.
  constexpr double kMargin = 4.0;
  constexpr double kStandardErrors = 2.0;
  // A drift of the residuals is a model error only if its correlation time is above this multiple
  // of the filter's time constant T, because the filter itself correlates the noise of the speed
  // over about T.
  constexpr double kOverLag = 3.0;
  const std::vector<CoastCandidate> filters = fit_filters(data, plain.at);
  const CoastCandidate& best = filters[0];
  const double margin = is_slow(best.at, data) ? kClose : kMargin;
  if (!(best.aicc + margin < plain.aicc)) return;
  const CoastFit fit = fit_coast(data.curves, data.surge, best.at);
  const bool is_significant =
      fit.usable && fit.lag->value_s > kStandardErrors * std::sqrt(fit.lag->variance);
  if (!is_significant) return;
  model.start = best.at;
  model.noise = best.noise;
  model.noise.longest_filter_s = std::max(kOverLag * best.at.lag_s, longest_drift_s(data, best.at));
  model.other = competitor(plain, filters[1], best, fit, data);
}

/// Speed below which a residual is an integration error, m/s.
double exact_mps(const std::vector<CoastCurve>& curves) { return 1e-4 * highest_speed_mps(curves); }

/// True if the fit `given`, without a filter and with the surge law fixed, describes the curves:
/// its residuals are integration errors, or they are white and a filter does not lower AICc.
bool is_described(const CoastData& data, const CoastCandidate& given) {
  if (given.noise.std() < exact_mps(data.curves)) return true;
  return !(given.noise.drift_std > 0.0) &&
         !(fit_once(data, fast_filter(data, given.at), 0.0).aicc < given.aicc);
}

/// The data of the curves for one surge law.
CoastData data_of(const CoastReadings& readings, const SteadyFit& surge) {
  return {
      readings.curves, surge,
      std::max({pooled_noise(readings.curves), readings.quantum_mps, exact_mps(readings.curves)})};
}

/// The best model of the curves for one surge law, which may vary within its covariance: without a
/// filter or, if AICc is lower, with one. A filter would correlate the residuals of a fit without
/// it, so it is not tried if they are white.
CoastCandidate best_candidate_of(const CoastData& data) {
  CoastCandidate plain = fit_candidate(data, {guess_log_mass(data.curves, data.surge.law())});
  const bool is_white = !(plain.noise.drift_std > 0.0);
  if (std::ranges::any_of(data.curves, &CoastCurve::of_bins) || !std::isfinite(plain.aicc) ||
      is_white) {
    return plain;
  }
  CoastCandidate filtered = fit_filters(data, plain.at).front();
  return filtered.aicc < plain.aicc ? filtered : plain;
}

/// True if the law describes the curves, as in choose_coast_model().
bool describes(const CoastReadings& readings, const SteadyFit& law) {
  const CoastData data = data_of(readings, law);
  const CoastCandidate given = fit_once(data, {guess_log_mass(data.curves, law.law())}, 0.0);
  return !std::isfinite(given.aicc) || is_described(data, given);
}

}  // namespace

std::optional<LawOfCurves> law_of_curves(const CoastReadings& readings,
                                         const std::vector<ScoredLaw>& laws) {
  if (laws.size() < 2 || readings.curves.empty() || describes(readings, laws.front().fit)) {
    return std::nullopt;
  }
  std::vector<CoastCandidate> fits;
  const CoastCandidate* reference = nullptr;
  fits.reserve(laws.size());
  for (const ScoredLaw& law : laws) {
    fits.push_back(best_candidate_of(data_of(readings, law.fit)));
    if (!std::isfinite(fits.back().aicc)) continue;
    if (!reference || fits.back().residuals.norm() < reference->residuals.norm()) {
      reference = &fits.back();
    }
  }
  if (!reference || !std::isfinite(fits.front().aicc)) return std::nullopt;
  const auto score = [&](std::size_t k) {
    return laws[k].aicc + fits[k].penalty +
           cost_of_residuals(fits[k].residuals, readings.curves, reference->noise);
  };
  LawOfCurves best;
  for (std::size_t k = 1; k < laws.size(); ++k) {
    if (!std::isfinite(fits[k].aicc)) continue;
    const double decrease = score(0) - score(k);
    if (decrease > best.decrease) best = {k, decrease};
  }
  const CoastCandidate& chosen = fits[best.index];
  ChannelNoise noise = chosen.noise;
  noise.longest_filter_s = longest_drift_s(data_of(readings, laws[best.index].fit), chosen.at);
  if (best.decrease <= kFamilyAicThreshold || noise.of_the_model()) return std::nullopt;
  return best;
}

CoastModel choose_coast_model(const CoastReadings& readings, const SteadyFit& surge) {
  const std::vector<CoastCurve>& curves = readings.curves;
  const CoastData data = data_of(readings, surge);
  const CoastCandidate given = fit_once(data, {guess_log_mass(curves, surge.law())}, 0.0);
  CoastModel model{.start = given.at, .other = {}, .noise = {}};
  if (!std::isfinite(given.aicc) || is_described(data, given)) return model;
  const CoastCandidate plain = fit_candidate(data, given.at);
  if (!std::isfinite(plain.aicc)) return model;
  model.noise = plain.noise;
  model.noise.longest_filter_s = longest_drift_s(data, given.at);
  if (std::ranges::none_of(curves, &CoastCurve::of_bins)) add_filter(data, plain, model);
  return model;
}

std::vector<Finding> inadequacy(const CoastModel& model, const std::string& file) {
  if (!model.noise.of_the_model()) return {};
  return {{file, 0, Severity::kWarning, "model-inadequate",
           fmt::format("the measured speeds of the coast-downs deviate from the fitted curve "
                       "by {:.2g} m/s for {:.2g} s at a time (sensor noise: {:.2g} m/s). "
                       "Either the resistance differs from that of the surge runs (check "
                       "slope, brakes and the resistance family), or the sensor distorts the "
                       "speed. {}",
                       model.noise.drift_std, model.noise.correlation_s, model.noise.sensor_std,
                       model.withdraws_intervals()
                           ? "The interval of mass_norm is withdrawn"
                           : "The confidence interval of mass_norm does not allow for this "
                             "deviation")}};
}

}  // namespace awmr
