#include "awmr/identify/logs/choice/family_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/identify/logs/problem/nearest_curve.h"
#include "awmr/trials/log_start.h"

namespace awmr {
namespace {

void hold_exponent(LogFitOptions& options, ParameterId beta) {
  std::erase(options.free, beta);
  options.initial_guess[at(beta)] = 1.0;
}

/// Makes a term free, with the initial guess `guess` unless it already has one.
void free_term(LogFitOptions& options, ParameterId id, double guess) {
  if (!options.frees(id)) options.free.push_back(id);
  double& value = options.initial_guess[at(id)];
  if (!(value > 0.0)) value = guess;
}

LogFitOptions with_families(LogFitOptions options, Family surge_family, Family yaw_family) {
  // Initial guess of the Coulomb friction, as a fraction of the resistance at 1 m/s or 1 rad/s.
  constexpr double kCoulombShare = 0.1;
  const FamilyTerms surge = terms_of(surge_family);
  const FamilyTerms yaw = terms_of(yaw_family);
  const double surge_force = options.initial_guess[at(ParameterId::kSurgeAlpha)];
  const double yaw_force = options.initial_guess[at(ParameterId::kYawAlpha)];
  if (!surge.beta) hold_exponent(options, ParameterId::kSurgeBeta);
  if (!yaw.beta) hold_exponent(options, ParameterId::kYawBeta);
  if (surge.coulomb) free_term(options, ParameterId::kSurgeCoulomb, kCoulombShare * surge_force);
  if (surge.quadratic) free_term(options, ParameterId::kSurgeQuadratic, 0.0);
  if (surge.dead_zone) free_term(options, ParameterId::kWheelDeadZone, 0.05);
  if (yaw.coulomb) free_term(options, ParameterId::kYawCoulomb, kCoulombShare * yaw_force);
  if (yaw.quadratic) free_term(options, ParameterId::kYawQuadratic, 0.0);
  if (!options.frees(ParameterId::kWheelDeadZone)) {
    std::erase_if(options.terms, [](const FreeTerm& term) {
      return term.quantity.kind == FreeQuantity::Kind::kDeadZoneDifference;
    });
  }
  return options;
}

/// Options of a fit of the families `surge` and `yaw` that starts at the optimum of `inner`, a fit
/// of other families. Terms that the new families lack, and terms that are 0 in `inner`, get the
/// initial values of `power_law`.
LogFitOptions without_terms(const LogFitOptions& power_law, const FamilyFit& inner, Family surge,
                            Family yaw) {
  LogFitOptions options = from_optimum(power_law, inner);
  std::vector<ParameterId> free = with_families(options, surge, yaw).free;
  std::erase_if(free, [&](ParameterId id) { return !(options.initial_guess[at(id)] > 0.0); });
  reset_terms(free, power_law.initial_guess, options.initial_guess);
  return options;
}

/// Largest absolute value of a channel in the logs (m/s or rad/s); 1 without measurements.
double fastest(const std::vector<DrivingLog>& logs, LogChannel channel) {
  double most = 0.0;
  for (const DrivingLog& log : logs) most = std::max(most, largest_measured(log, channel));
  return most > 0.0 ? most : 1.0;
}

/// Sets the resistance parameters in `values`, the initial guess of a fit of the families `surge`
/// and `yaw`, so that their curves are as close as possible to the fitted curves of `inner`.
void begin_near(const std::vector<DrivingLog>& logs, const FamilyFit& inner, Family surge,
                Family yaw, ParameterValues<double>& values) {
  const Vehicle& vehicle = inner.options.vehicle;
  const Plant<double> plant = plant_of(vehicle, fitted_values(inner.options, inner.fit));
  const double wheels = vehicle.driven_wheels();
  if (surge != inner.surge) {
    Resistance<double> curve = plant.surge;
    curve.coulomb += wheels * plant.wheel_dead_zone;
    const FamilyTerms terms = terms_of(surge);
    const auto near = nearest_curve(curve, terms, fastest(logs, LogChannel::kSpeed));
    const double each = near.coulomb / (terms.coulomb && terms.dead_zone ? 2.0 : 1.0);
    values[at(ParameterId::kSurgeAlpha)] = near.alpha;
    values[at(ParameterId::kSurgeBeta)] = near.beta;
    values[at(ParameterId::kSurgeCoulomb)] = terms.coulomb ? each : 0.0;
    values[at(ParameterId::kWheelDeadZone)] = terms.dead_zone ? each / wheels : 0.0;
    values[at(ParameterId::kSurgeQuadratic)] = near.quadratic;
  }
  if (yaw != inner.yaw) {
    const auto near = nearest_curve(plant.yaw, terms_of(yaw), fastest(logs, LogChannel::kYawRate));
    values[at(ParameterId::kYawAlpha)] = near.alpha;
    values[at(ParameterId::kYawBeta)] = near.beta;
    values[at(ParameterId::kYawCoulomb)] = near.coulomb;
    values[at(ParameterId::kYawQuadratic)] = near.quadratic;
  }
}

/// Resets the sway resistance to `guess` if the fit `inner` could not determine it. Its value may
/// then be near 0 or so large that the motion no longer depends on it, and a search that starts
/// there would not leave this value. (fit_from() also starts at the old value.)
void reset_undetermined_sway(const LogFit& inner, double guess, ParameterValues<double>& values) {
  const auto i = place_of(inner.quantities, ParameterId::kSwayAlpha);
  if (i && !inner.refusal_reason[*i].empty()) values[at(ParameterId::kSwayAlpha)] = guess;
}

/// Options of a fit of the families `surge` and `yaw` that starts at their curves nearest to the
/// fitted curves of `inner`. `at_optimum`: result of without_terms().
LogFitOptions near_options(const std::vector<DrivingLog>& logs, LogFitOptions at_optimum,
                           const FamilyFit& inner, Family surge, Family yaw) {
  begin_near(logs, inner, surge, yaw, at_optimum.initial_guess);
  return with_families(std::move(at_optimum), surge, yaw);
}

/// Noise model of the fit with the smaller errors.
const NoiseLevels& noise_of_better(const LogFit& a, const LogFit& b) {
  return size_of_errors({&a}).size <= size_of_errors({&b}).size ? a.noise : b.noise;
}

/// True if the errors of the fit are hardly larger than the sensor noise (LogFit::relative_error
/// below 1.2), and all its delays, lags and command errors are significant. Terms of single logs do
/// not count, because a fit contains those of all logs even if only one of them is significant.
bool has_right_terms(const LogFit& fit) {
  constexpr double kErrorOfSensors = 1.2;
  if (!(fit.relative_error < kErrorOfSensors)) return false;
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    const bool is_term = q.kind != FreeQuantity::Kind::kParameter &&
                         q.kind != FreeQuantity::Kind::kBias && q.log == 0;
    if (is_term && q.scale == Scale::kLinear && !q.is_form() && !fit.is_significant(i))
      return false;
  }
  return true;
}

}  // namespace

void SquareSum::add(const std::vector<ErrorSeries>& errors) {
  for (const ErrorSeries& part : errors) {
    for (const double e : part.error) squares += e * e;
    count += static_cast<double>(part.error.size());
  }
}

ErrorSize size_of_errors(std::initializer_list<const LogFit*> fits) {
  std::map<LogSensor, SquareSum> sums;
  for (const LogFit* fit : fits) {
    for (const auto& [sensor, errors] : fit->errors) sums[sensor].add(errors);
  }
  ErrorSize found;
  for (const auto& [sensor, sum] : sums) {
    const auto [squares, n] = sum;
    found.size += n * std::log(std::max(squares / n, kMinimumStd * kMinimumStd));
    found.count += n;
  }
  return found;
}

double aic_under(const NoiseLevels& noise, const LogFit& fit, double most) {
  double aic = 2.0 * static_cast<double>(fit.quantities.size()) + fit.change_cost;
  for (const auto& [sensor, errors] : fit.errors) {
    aic += cost_of(errors, sensor_in(noise, sensor.channel, sensor.log).second, most);
  }
  return aic;
}

double aic_lead(const LogFit& a, const LogFit& b, double most) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!a.usable || !b.usable) return a.usable ? kInfinity : b.usable ? -kInfinity : 0.0;
  const NoiseLevels& noise = noise_of_better(a, b);
  return aic_under(noise, b, most) - aic_under(noise, a, most);
}

FamilyFit fit_with(const std::vector<DrivingLog>& logs, LogFitOptions options, Family surge,
                   Family yaw) {
  FamilyFit result{surge, yaw, std::move(options), {}};
  result.fit = fit_logs(logs, result.options);
  for (const ParameterId coulomb : result.options.optional_coulomb) {
    if (!has(result.fit.quantities, coulomb)) continue;
    result.options.free.push_back(coulomb);
    (coulomb == ParameterId::kYawCoulomb ? result.yaw : result.surge) = Family::kCoulombPower;
  }
  result.options.optional_coulomb.clear();
  result.fit.report.family = families_in_words(result.surge, result.yaw);
  if (result.options.frees(ParameterId::kBackEmf)) result.fit.report.family += ", back-EMF";
  if (result.fit.usable) result.fit.report.aicc = aic_under(result.fit.noise, result.fit);
  result.options.give_up_above = LogFitOptions{}.give_up_above;
  result.options.best_so_far.reset();
  return result;
}

bool is_over(const LogFitOptions& options) {
  if (options.effort && options.effort->is_over()) return true;
  return options.deadline && std::chrono::steady_clock::now() >= *options.deadline;
}

std::string families_in_words(Family surge, Family yaw) {
  if (yaw == Family::kPower) return std::string(name_of(surge));
  return fmt::format("{}, yaw {}", name_of(surge), name_of(yaw));
}

void reset_terms(const std::vector<ParameterId>& free, const ParameterValues<double>& power_law,
                 ParameterValues<double>& values) {
  for (const ParameterInfo& parameter : parameter_table()) {
    if (!parameter.term || contains(free, parameter.id)) continue;
    values[at(parameter.id)] = power_law[at(parameter.id)];
  }
}

LogFitOptions from_optimum(LogFitOptions options, const FamilyFit& fit) {
  options = with_terms_of(fit.fit, std::move(options));
  options.initial_guess = fitted_values(fit.options, fit.fit);
  options.guessed.clear();
  options.also_from.clear();
  options.finds_delays = false;
  return options;
}

std::optional<Extended> solution_of(const std::vector<DrivingLog>& logs, const FamilyFit& solved) {
  const LogFit& fit = solved.fit;
  LogProblem problem = log_problem(logs, from_optimum(solved.options, solved));
  if (problem.model.initial.size() * problem.windows.size() != fit.initial_states.size()) return {};
  problem.model.quantities = fit.quantities;
  problem.initial = fit.coordinates;
  problem.bounds = coordinate_bounds(fit.quantities, fit.coordinates, problem.model.vehicle);
  problem.model.longest_step_s = step_s_at(problem.model, fit.coordinates);
  set_noise(fit.noise, problem);
  return Extended{std::move(problem), {fit.coordinates, fit.initial_states}};
}

FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw) {
  return fit_with(logs, with_families(power_law, surge, yaw), surge, yaw);
}

FamilyFit fit_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& inner, Family surge, Family yaw,
                   const std::vector<FreeTerm>& more) {
  if (!inner.fit.usable) return fit_family(logs, power_law, surge, yaw);
  LogFitOptions at_optimum = without_terms(power_law, inner, surge, yaw);
  append(at_optimum.terms, more);
  LogFitOptions options = near_options(logs, at_optimum, inner, surge, yaw);
  reset_undetermined_sway(inner.fit, power_law.initial_guess[at(ParameterId::kSwayAlpha)],
                          options.initial_guess);
  options.also_from = {at_optimum.initial_guess};
  return fit_with(logs, std::move(options), surge, yaw);
}

FamilyFit fit_roughly_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const FamilyFit& inner, Family surge, Family yaw,
                           const std::vector<FreeTerm>& more) {
  LogFitOptions options =
      near_options(logs, without_terms(power_law, inner, surge, yaw), inner, surge, yaw);
  append(options.terms, more);
  const LogFit fit = fit_roughly(logs, options);
  return {surge, yaw, std::move(options), fit};
}

FamilyFit with_new_terms(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const FamilyFit& fit) {
  LogFitOptions options = from_optimum(fit.options, fit);
  options.finds_delays = true;
  options.optional_coulomb = power_law.optional_coulomb;
  if (!has_right_terms(fit.fit)) {
    std::erase_if(options.terms,
                  [](const FreeTerm& term) { return !term.quantity.is_stribeck_or_slope(); });
    append(options.terms, power_law.terms);
  }
  return fit_with(logs, std::move(options), fit.surge, fit.yaw);
}

LogFitOptions with_limits_of(const FamilyFit& best, const std::vector<DrivingLog>& logs,
                             LogFitOptions options) {
  constexpr double kFarWorse = 1.5;
  if (!best.fit.usable) return options;
  options.give_up_above =
      std::min(options.give_up_above, kFarWorse * std::max(1.0, best.fit.relative_error));
  const FamilyFit rough = fit_roughly_from(logs, options, best, best.surge, best.yaw, {});
  options.best_so_far = BestSoFar{.relative_error = rough.fit.relative_error,
                                  .has_large_drift = best.fit.has_large_drift()};
  return options;
}

LogFitOptions with_limits_for_gain(const FamilyFit& best, const std::vector<DrivingLog>& logs,
                                   LogFitOptions options) {
  if (!best.fit.usable) return options;
  options = with_limits_of(best, logs, std::move(options));
  options.best_so_far->needs_large_gain = std::ranges::none_of(
      best.fit.noise, [](const auto& channel) { return channel.second.has_slow_drift(); });
  return options;
}

FamilyFit fit_stribeck(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       const FamilyFit& inner, bool of_yaw) {
  constexpr double kShare = 0.3;  // initial guess of Stribeck friction over the resistance
  const Plant<double> plant =
      plant_of(inner.options.vehicle, fitted_values(inner.options, inner.fit));
  const ExtraForce force = of_yaw ? ExtraForce::kYawStribeck : ExtraForce::kSurgeStribeck;
  const LogChannel channel = of_yaw ? LogChannel::kYawRate : LogChannel::kSpeed;
  const double top = fastest(logs, channel);
  const double resistance = (of_yaw ? plant.yaw : plant.surge).at(kStribeckShare * top);
  return fit_from(logs, power_law, inner, of_yaw ? inner.surge : Family::kCoulombLinear,
                  of_yaw ? Family::kCoulombLinear : inner.yaw,
                  {{extra_force(force), kShare * resistance}, stribeck_speed_term(force, top)});
}

FamilyFit searched_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         FamilyFit first, const FamilyFit& alternative) {
  constexpr double kWorthSearching = 2.0;  // lead in AIC that is worth another search
  if (!(aic_lead(alternative.fit, first.fit) > kWorthSearching)) return first;
  FamilyFit again = fit_from(logs, power_law, alternative, first.surge, first.yaw);
  return aic_lead(again.fit, first.fit) > 0.0 ? std::move(again) : std::move(first);
}

}  // namespace awmr
