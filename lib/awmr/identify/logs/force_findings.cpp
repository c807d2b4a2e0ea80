#include "awmr/identify/logs/force_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/core/index.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

constexpr double kStandardErrors = 2.0;  // smallest force that is reported

/// An identified quantity with its standard error.
struct FoundForce {
  double value;
  double error;
};

std::optional<FoundForce> found_force(const LogFit& fit, ExtraForce force) {
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    if (!q.is(force) || !fit.refusal_reason[i].empty()) continue;
    const double x = fit.coordinates[i];
    const Eigen::Index row = eigen_index(i);
    return FoundForce{q.value(x), q.jacobian(x) * std::sqrt(fit.covariance(row, row))};
  }
  return std::nullopt;
}

/// Value of a parameter of the fit; 0 if it is not free.
double fitted_value(const LogFit& fit, ParameterId id) {
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    if (fit.quantities[i].is(id)) return fit.quantities[i].value(fit.coordinates[i]);
  }
  return 0.0;
}

std::vector<Finding> stribeck_findings(const LogFit& fit, const std::string& file) {
  struct Axis {
    ExtraForce force;
    ExtraForce speed;
    ParameterId coulomb;
    std::string_view what;
    std::string_view unit;
  };
  constexpr Axis kAxes[] = {
      {ExtraForce::kSurgeStribeck, ExtraForce::kSurgeStribeckSpeed, ParameterId::kSurgeCoulomb,
       "rolling", "m/s"},
      {ExtraForce::kYawStribeck, ExtraForce::kYawStribeckSpeed, ParameterId::kYawCoulomb, "turning",
       "rad/s"}};
  std::vector<Finding> findings;
  for (const Axis& axis : kAxes) {
    const auto force = found_force(fit, axis.force);
    if (!force || force->value < kStandardErrors * force->error) continue;
    const auto speed = found_force(fit, axis.speed);
    findings.push_back(
        {file, 0, Severity::kWarning, "stribeck-friction",
         fmt::format("the friction of {} rises at low speed (Stribeck effect): by {:.2g} +- {:.2g} "
                     "to the Coulomb friction {:.2g}{}. The fit compensates this, but simulations "
                     "and gains do not; drive faster than that",
                     axis.what, force->value, force->error, fitted_value(fit, axis.coulomb),
                     speed ? fmt::format(", mainly below {:.2g} {}", speed->value, axis.unit) : "")});
  }
  return findings;
}

std::vector<Finding> slope_findings(const LogFit& fit, const std::string& file) {
  constexpr double kGravity_mps2 = 9.81;
  const auto x = found_force(fit, ExtraForce::kSlopeX);
  const auto y = found_force(fit, ExtraForce::kSlopeY);
  if (!x || !y) return {};
  const double size = std::hypot(x->value, y->value);
  const double error = std::hypot(x->error * x->value, y->error * y->value) / size;
  if (!(size > kStandardErrors * error)) return {};
  return {{file, 0, Severity::kWarning, "slope",
           fmt::format("a constant force pushes the vehicle towards the heading {:.0f} deg with "
                       "{:.3f} +- {:.3f} m/s^2, like ground that falls by {:.2f} deg. The fit "
                       "compensates this, but simulations do not; record logs on level ground",
                       degrees(std::atan2(y->value, x->value)), size, error,
                       degrees(std::asin(std::min(1.0, size / kGravity_mps2))))}};
}

}  // namespace

std::vector<Finding> force_findings(const LogFit& fit, const std::string& file) {
  std::vector<Finding> findings = stribeck_findings(fit, file);
  for (Finding& slope : slope_findings(fit, file)) findings.push_back(std::move(slope));
  return findings;
}

}  // namespace awmr
