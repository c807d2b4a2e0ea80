#include "awmr/identify/tables/turn_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/statistics/linear_algebra.h"

namespace awmr {
namespace {

constexpr std::size_t kMinPerSide = 2;
constexpr std::size_t kMinTurns = 6;
constexpr double kSideLevel = 0.01;  ///< significance level of the moment M
constexpr Eigen::Index kUnknowns = 3;

/// Sign of the turn of each point: 1 to the left, -1 to the right.
Eigen::VectorXd signs_of(const Subject& yaw, const TrialSet<TurningRow>& runs) {
  std::set<int> right;
  for (const TurningRow& row : runs.rows) {
    if (row.is_right_turn) right.insert(row.line);
  }
  Eigen::VectorXd signs(rows_of(yaw.points));
  for (Eigen::Index i = 0; i < signs.size(); ++i) {
    signs(i) = right.contains(yaw.points[at(i)].line) ? -1.0 : 1.0;
  }
  return signs;
}

Finding turns_differ(const std::string& file, double moment_m, double std_error_m, double p) {
  return {file, 0, Severity::kWarning, "turns-differ",
          fmt::format("left and right turns differ as if a constant yaw moment of {:.2g} +- "
                      "{:.1g} m (divided by F_max) turned the vehicle to the {} (p = {:.2g}): "
                      "unequal motors or drag, or wheels out of line. The parameters of the yaw "
                      "resistance get no intervals; correct the cause and repeat the turns",
                      std::abs(moment_m), std_error_m, moment_m > 0.0 ? "left" : "right", p)};
}

}  // namespace

std::optional<Finding> compare_sides(const Subject& yaw, const TrialSet<TurningRow>& runs) {
  const Eigen::VectorXd signs = signs_of(yaw, runs);
  const auto right = static_cast<std::size_t>((signs.array() < 0.0).count());
  const std::size_t turns = yaw.points.size();
  if (turns < kMinTurns || std::min(right, turns - right) < kMinPerSide) return std::nullopt;
  Eigen::MatrixXd design(rows_of(yaw.points), kUnknowns);
  Eigen::VectorXd observed(design.rows());
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const SteadyPoint& point = yaw.points[at(i)];
    design.row(i) << 1.0, std::log(point.rate), -signs(i) / point.force;
    observed(i) = std::log(point.force);
  }
  const PivotedQr qr(design);
  if (qr.rank() < kUnknowns) return std::nullopt;
  const Eigen::VectorXd solution = qr.solve(observed);
  const auto freedom = static_cast<double>(design.rows() - kUnknowns);
  const double variance = (design * solution - observed).squaredNorm() / freedom;
  const double moment_m = solution(2);
  const double std_error_m = std::sqrt(variance * qr.inverse_information()(2, 2));
  if (!(std_error_m > 0.0)) return std::nullopt;
  const double p = 2.0 * students_t_tail(std::abs(moment_m) / std_error_m, freedom);
  if (p > kSideLevel) return std::nullopt;
  return turns_differ(yaw.file, moment_m, std_error_m, p);
}

}  // namespace awmr
