#include "awmr/identify/tables/subject.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "awmr/core/statistics/distributions.h"

namespace awmr {
namespace {

std::vector<SteadyPoint> surge_points(const std::vector<SurgeRow>& rows) {
  std::vector<SteadyPoint> points;
  points.reserve(rows.size());
  for (const SurgeRow& row : rows) {
    points.push_back({row.tau_speed, row.speed_mps, row.distance_m, row.elapsed_s, row.line});
  }
  return points;
}

/// Fraction of the commanded yaw moment that remains after subtracting the wheels' dead zones; 0 if
/// all wheel forces are within the dead zone.
double share_beyond(const TurningRow& row, double dead_zone) {
  if (!row.sides && !(row.wheel_force > dead_zone)) return 0.0;
  if (!(dead_zone > 0.0)) return 1.0;
  if (!row.sides) return 1.0 - dead_zone / row.wheel_force;
  const double left = beyond_dead_zone(row.sides->left, dead_zone);
  const double right = beyond_dead_zone(row.sides->right, dead_zone);
  return (right - left) / (row.sides->right - row.sides->left);
}

/// Families for the surge table. Excludes `dead-zone-coulomb`, and `dead-zone` unless the vehicle
/// has four driven wheels.
std::vector<Family> surge_families(const Vehicle& vehicle) {
  const auto all = values_in(kFamilyNames);
  std::vector<Family> families(all.begin(), all.end());
  std::erase(families, Family::kDeadZoneCoulomb);
  if (vehicle.driven_wheels() != 4) std::erase(families, Family::kDeadZone);
  return families;
}

}  // namespace

Subject surge_subject(const Vehicle& vehicle, const TrialSet<SurgeRow>& runs) {
  return {.name = FitSubject::kSurge,
          .families = surge_families(vehicle),
          .beta_range = vehicle.surge_beta_range,
          .file = runs.file,
          .points = surge_points(runs.rows)};
}

Subject yaw_subject(const Vehicle& vehicle, const TrialSet<TurningRow>& runs, double dead_zone) {
  return {.name = FitSubject::kYaw,
          .alpha = ParameterId::kYawAlpha,
          .beta = ParameterId::kYawBeta,
          .coulomb = ParameterId::kYawCoulomb,
          .quadratic = ParameterId::kYawQuadratic,
          .families = {Family::kPower, Family::kCoulombLinear, Family::kCoulombLinearQuadratic,
                       Family::kCoulombPower},
          .beta_range = vehicle.yaw_beta_range,
          .file = runs.file,
          .points = turning_points(runs.rows, dead_zone)};
}

std::vector<SteadyPoint> turning_points(const std::vector<TurningRow>& rows, double dead_zone) {
  std::vector<SteadyPoint> points;
  for (const TurningRow& row : rows) {
    const double share = share_beyond(row, dead_zone);
    if (!(share > 0.0)) continue;
    SteadyPoint point{share * row.tau_turn_m, row.yaw_rate_radps, {}, row.elapsed_s, row.line};
    if (row.turns) point.travel = 2.0 * std::numbers::pi * *row.turns;
    points.push_back(point);
  }
  return points;
}

ParameterId parameter_of(const Subject& subject, TransformedParameter c) {
  switch (c) {
    case TransformedParameter::kLogAlpha:
      return subject.alpha;
    case TransformedParameter::kBeta:
      return subject.beta;
    case TransformedParameter::kCoulomb:
      return subject.coulomb;
    case TransformedParameter::kQuadratic:
      return subject.quadratic;
    case TransformedParameter::kDeadZone:
      return ParameterId::kWheelDeadZone;
  }
  return subject.alpha;
}

Estimate estimate_of(const SteadyFit& fit, TransformedParameter c,
                     const std::optional<Interval>& interval, const std::string& method) {
  Estimate estimate{value_from(c, fit[c]), {}, {}, Source::kFitted, method};
  const auto error = fit.std_error(c);
  if (!error) return estimate;
  estimate.std_error = jacobian_of(c, fit[c]) * *error;
  const double half = t_quantile_95(fit.degrees_of_freedom) * *error;
  estimate.ci95 = interval ? *interval : values_from(c, {fit[c] - half, fit[c] + half});
  return estimate;
}

EstimatorReport report_of(const Subject& subject, const SteadyFit& fit, Family family,
                          Estimator estimator, std::string_view noise) {
  EstimatorReport report;
  report.subject = subject.name;
  report.estimator = estimator;
  report.noise = noise;
  report.family = name_of(family);
  for (const TransformedParameter c : coordinates_of(family)) {
    const Estimate estimate =
        estimate_of(fit, c, {}, std::string(name_in(kEstimatorNames, estimator)));
    report.parameters.push_back({std::string(info(parameter_of(subject, c)).name), *estimate.value,
                                 estimate.std_error, estimate.ci95});
  }
  report.residual_std =
      fit.degrees_of_freedom > 0 ? fit.residual_std : std::numeric_limits<double>::quiet_NaN();
  report.rows_used = static_cast<int>(subject.points.size());
  report.degrees_of_freedom = fit.degrees_of_freedom;
  report.rank = fit.rank;
  report.condition_number = fit.condition_number;
  report.stop_reason = fit.stop_reason;
  return report;
}

}  // namespace awmr
