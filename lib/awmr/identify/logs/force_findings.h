/// Findings about forces that the model does not contain (extra_forces.h). Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Value of an identified quantity, and its standard error.
struct Identified {
  double value = 0.0;
  double error = 0.0;
};

/// The quantity `what` (place_of()), if the fit contains and identifies it.
template <class What>
std::optional<Identified> identified(const LogFit& fit, What what) {
  const auto i = place_of(fit.quantities, what);
  if (!i || !fit.refusal_reason[*i].empty()) return std::nullopt;
  const FreeQuantity& q = fit.quantities[*i];
  const double x = fit.coordinates[*i];
  return Identified{q.value(x), q.jacobian(x) * fit.error_of(*i)};
}

/// True if the value exceeds two standard errors. If it does not, it can be due to noise.
bool is_significant(const Identified& quantity);

/// Length of a vector with these components. The components are assumed to be uncorrelated.
Identified length_of(const Identified& x, const Identified& y);

/// Returns one finding for each force of extra_forces.h that differs from 0 by more than two
/// standard errors.
std::vector<Finding> force_findings(const LogFit& fit, const std::string& file);

/// Withdraws the intervals of a resistance whose Stribeck friction is above 5 % of its Coulomb
/// friction. All terms of this resistance depend on how the friction decreases with speed, and the
/// logs do not show the true form of this decrease. (m' and I'z depend on it much less.)
void withdraw_by_stribeck(LogFit& fit);

}  // namespace awmr
