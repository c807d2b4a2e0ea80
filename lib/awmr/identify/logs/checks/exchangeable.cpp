#include <fmt/format.h>

#include <cmath>
#include <string>

#include "awmr/identify/logs/checks/log_checks.h"
#include "awmr/identify/logs/choice/exchanged_lags.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// The measurement that decides between the two values of a lag.
std::string remedy(const FreeQuantity& lag) {
  if (lag.is(Kind::kMotorLag)) {
    return "measure the motors' lag on the bench and set motor.time_constant_s in the vehicle "
           "file, or add a coast-down trial";
  }
  if (lag.is(ParameterId::kSteeringTimeConstant)) {
    return "log the measured steering angle (steering_deg)";
  }
  return "log the unfiltered reading, or positions and headings";
}

}  // namespace

void refuse_exchangeable(const std::vector<DrivingLog>& logs, FamilyFit& chosen) {
  constexpr double kOtherValue = 2.0;  // standard errors
  LogFit& fit = chosen.fit;
  if (!fit.usable) return;
  const auto at = solution_of(logs, chosen);
  if (!at) return;
  const auto other = equally_likely_exchange(at->problem, at->point);
  if (!other) return;
  const FreeQuantity& lag = fit.quantities[other->lag];
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    const double change = std::abs(other->coordinates[i] - fit.coordinates[i]);
    const bool is_inertia = q.is(ParameterId::kMassNorm) || q.is(ParameterId::kInertiaNorm);
    if (!(is_inertia || i == other->lag) || !(change > kOtherValue * fit.error_of(i))) continue;
    fit.refusal_reason[i] = fmt::format(
        "these logs allow two values, {:.3g} and {:.3g}: {} of {:.3g} or {:.3g} s describes them "
        "about equally well (AIC differs by {:.2g}), because a lag and the inertia have nearly the "
        "same effect when their time constants are exchanged; {}",
        q.value(fit.coordinates[i]), q.value(other->coordinates[i]), lag.name(),
        lag.value(fit.coordinates[other->lag]), lag.value(other->coordinates[other->lag]),
        other->aic_excess, remedy(lag));
  }
}

}  // namespace awmr
