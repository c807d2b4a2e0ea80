#include "awmr/identify/logs/identifiability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// A coordinate whose standard error is this share of its large change is not shown by the data: a
/// factor of 2.7 either way at 95 % for a logarithm, 1 for an exponent.
constexpr double kUnknown = 0.5;

/// In words, how little is known of a quantity; `std` is its standard error over its large change.
std::string how_open(double std) {
  if (!std::isfinite(std) || std > 1e3) return "nothing measured depends on it";
  return fmt::format("its standard error is {:.2g} times what would be of use", std / kUnknown);
}

/// Says of every quantity with a part in an open direction (of length 1) why it is open.
void refuse_direction(const Eigen::VectorXd& direction, double std,
                      const std::vector<FreeQuantity>& quantities,
                      std::vector<std::string>& why_not) {
  constexpr double kPart = 0.1;  // of the squared length
  std::vector<std::size_t> parts;
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (direction(i) * direction(i) < kPart) continue;
    parts.push_back(at(i));
    names.push_back(quantities[at(i)].name());
  }
  const std::string why = names.size() == 1
                              ? "these logs leave it open: " + how_open(std)
                              : fmt::format("these logs show only a combination of {}: {}",
                                            fmt::join(names, ", "), how_open(std));
  for (const std::size_t i : parts) why_not[i] = why;
}

std::optional<std::size_t> place_of(const std::vector<FreeQuantity>& quantities, ParameterId id) {
  const auto found = std::find_if(quantities.begin(), quantities.end(),
                                  [id](const FreeQuantity& q) { return q.is(id); });
  if (found == quantities.end()) return std::nullopt;
  return at(found - quantities.begin());
}

/// A delay and a family's term may be zero, the end of their range.
bool stopped(const FreeQuantity& q, double coordinate, const Interval& bounds) {
  if (q.kind == FreeQuantity::Kind::kDelay) return false;
  const bool term = q.kind == FreeQuantity::Kind::kParameter && info(q.id).term;
  if (term && coordinate == bounds.lo) return false;
  return coordinate <= bounds.lo || coordinate >= bounds.hi;
}

}  // namespace

Identifiability identifiability(const Eigen::MatrixXd& information,
                                const std::vector<FreeQuantity>& quantities) {
  const Eigen::Index n = rows_of(quantities);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale(i) = quantities[at(i)].large_change;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNull = 1e-12;
  const double largest = values(n - 1);
  Identifiability found;
  found.condition_number = values(0) > 0.0 ? std::sqrt(largest / values(0)) : kInfinity;
  found.why_not.resize(at(n));
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index d = 0; d < n; ++d) {
    const bool null = !(values(d) > kNull * largest);
    const double std = null ? kInfinity : 1.0 / std::sqrt(values(d));
    const Eigen::VectorXd direction = eigen.eigenvectors().col(d);
    if (std < kUnknown) {
      inverse += direction * direction.transpose() / values(d);
      ++found.rank;
    } else {
      refuse_direction(direction, std, quantities, found.why_not);
    }
  }
  found.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double std = std::sqrt(found.covariance(i, i)) / scale(i);
    std::string& why_not = found.why_not[at(i)];
    if (why_not.empty() && std > kUnknown) why_not = "these logs leave it open: " + how_open(std);
  }
  return found;
}

Identifiability without_stopped(Identifiability found, const LogProblem& problem,
                                const std::vector<double>& coordinates) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (!stopped(quantities[i], coordinates[i], problem.bounds[i])) continue;
    found.why_not[i] = fmt::format("the search ended at the end of its range, {:.4g}",
                                   quantities[i].value(coordinates[i]));
  }
  for (const auto& [alpha, beta] : {std::pair(ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta),
                                    std::pair(ParameterId::kYawAlpha, ParameterId::kYawBeta)}) {
    const auto factor = place_of(quantities, alpha);
    const auto exponent = place_of(quantities, beta);
    if (!factor || !exponent) continue;
    if (found.why_not[*factor].empty() || !found.why_not[*exponent].empty()) continue;
    found.why_not[*exponent] =
        fmt::format("{} is open, and an exponent says nothing without it", info(alpha).name);
  }
  return found;
}

}  // namespace awmr
