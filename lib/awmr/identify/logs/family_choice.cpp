#include "awmr/identify/logs/family_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// In a family without a free exponent the curve is linear: beta is held at 1.
void hold_exponent(LogFitOptions& options, ParameterId beta) {
  std::erase(options.free, beta);
  options.initial_guess[at(beta)] = 1.0;
}

/// Frees a term; its initial guess is `guess` unless it has one.
void free_term(LogFitOptions& options, ParameterId id, double guess) {
  if (std::find(options.free.begin(), options.free.end(), id) == options.free.end()) {
    options.free.push_back(id);
  }
  double& value = options.initial_guess[at(id)];
  if (!(value > 0.0)) value = guess;
}

LogFitOptions with_families(LogFitOptions options, Family surge_family, Family yaw_family) {
  constexpr double kCoulombShare = 0.1;  // of the power law's force at 1 m/s, 1 rad/s
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
  return options;
}

}  // namespace

FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw) {
  FamilyFit result{surge, with_families(power_law, surge, yaw), {}};
  result.fit = fit_logs(logs, result.options);
  result.fit.report.family = name_of(surge);
  if (std::isfinite(result.fit.aic)) result.fit.report.aicc = result.fit.aic;
  return result;
}

BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       Family yaw) {
  constexpr double kPlainlyBetter = 10.0;
  BestFamily result;
  result.best = fit_family(logs, power_law, Family::kPower, yaw);
  const double power_aic = result.best.fit.aic;
  for (const Family family : values_in(kFamilyNames)) {
    if (family == Family::kPower) continue;
    FamilyFit rival = fit_family(logs, power_law, family, yaw);
    const LogFit& best = result.best.fit;
    const bool better = rival.fit.usable && (!best.usable || rival.fit.aic < best.aic);
    if (better) std::swap(result.best, rival);
    result.others.push_back(rival.fit.report);
  }
  result.gain = power_aic - result.best.fit.aic;
  if (result.best.surge != Family::kPower && result.gain > kPlainlyBetter) {
    result.finding =
        Finding{logs.front().file, 0, Severity::kNote, "power-law-inadequate",
                fmt::format("a power law does not describe these logs: {} is better by {:.0f} of "
                            "AIC",
                            name_of(result.best.surge), result.gain)};
  }
  return result;
}

}  // namespace awmr
