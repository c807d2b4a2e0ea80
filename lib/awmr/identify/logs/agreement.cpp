#include "awmr/identify/logs/agreement.h"

#include <fmt/format.h>

#include <cmath>

#include "awmr/core/distributions.h"
#include "awmr/core/index.h"

namespace awmr {

std::optional<Finding> disagreement(const LogFit& fit, std::size_t i, const Estimate& known,
                                    const std::string& file) {
  constexpr double kSignificant = 0.01;
  if (!known.value || !known.std_error || !(*known.std_error > 0.0)) return std::nullopt;
  const FreeQuantity& q = fit.quantities[i];
  const double variance = fit.covariance(eigen_index(i), eigen_index(i));
  const double other = to_coordinate(q.scale, *known.value);
  const double other_std = *known.std_error / jacobian(q.scale, *known.value);
  const double z =
      std::abs(fit.coordinates[i] - other) / std::sqrt(variance + other_std * other_std);
  const double p = 2.0 * normal_tail(z);
  if (p >= kSignificant) return std::nullopt;
  return Finding{
      file, 0, Severity::kWarning, "estimates-disagree",
      fmt::format("{} is {:.4g} by the logs and {:.4g} by the other trials ({}), {:.1f} standard "
                  "deviations apart (p = {:.2g}); check the units and that all trials are of one "
                  "vehicle",
                  info(q.id).name, q.value(fit.coordinates[i]), *known.value, known.method, z, p)};
}

}  // namespace awmr
