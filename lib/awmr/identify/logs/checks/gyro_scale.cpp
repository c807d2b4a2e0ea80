#include "awmr/identify/logs/checks/log_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/logs/problem/information.h"
#include "awmr/identify/logs/problem/score_test.h"
#include "awmr/identify/logs/problem/widening.h"

namespace awmr {
namespace {

/// True if a scale error of the yaw rate can be compared with a heading or positions, but is not
/// estimated.
bool assumes_scale(const LogFit& fit) {
  const bool has_yaw_rate = has_channel(fit.noise, LogChannel::kYawRate);
  const bool has_heading =
      has_channel(fit.noise, LogChannel::kHeading) || has_channel(fit.noise, LogChannel::kX);
  return has_yaw_rate && has_heading &&
         !has_kind(fit.quantities, FreeQuantity::Kind::kSensorScale, LogChannel::kYawRate);
}

/// Scale error s of the yaw rate that remains possible with the logs, and its effect on the fit.
struct OpenScale {
  double std = 0.0;          ///< root of the mean square of s
  Eigen::VectorXd by_scale;  ///< change of the coordinates of the fit per s
};

/// Empty if the simulation is not finite.
std::optional<OpenScale> open_scale(Extended solution) {
  const Eigen::Index n = rows_of(solution.point.coordinates);
  const FreeQuantity scale = free_term(FreeQuantity::Kind::kSensorScale, LogChannel::kYawRate);
  const Extended with =
      extended(std::move(solution.problem), std::move(solution.point), {scale}, {0.0});
  const std::vector<WindowSums> sums = sums_at(with.problem, with.point);
  if (!all_finite(sums)) return std::nullopt;
  const auto [h, score] = fit_evidence(sums, n + 1);
  Eigen::MatrixXd of_others = h.topLeftCorner(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {  // weak prior of the search
    const double std = kPriorStd * with.problem.model.quantities[at(i)].large_change;
    of_others(i, i) += 1.0 / (std * std);
  }
  const Eigen::VectorXd by_others = solve_ldlt(of_others, h.topRightCorner(n, 1));
  const double information = h(n, n) - h.col(n).head(n).dot(by_others);
  const double with_prior = information + 1.0 / (kGyroScaleStd * kGyroScaleStd);
  const double mean = -(score(n) - by_others.dot(score.head(n))) / with_prior;
  return OpenScale{std::sqrt(1.0 / with_prior + mean * mean), -by_others};
}

Finding gyro_scale_finding(double scale_std, const std::string& file) {
  return {file, 0, Severity::kNote, "gyro-scale-open",
          fmt::format("heading or positions do not show whether yaw_rate_radps has a scale error "
                      "below {:.2g} %, and {:.0f} % are usual for gyroscopes. The intervals allow "
                      "for such an error, which changes I'z and the yaw resistance by as much. For "
                      "narrower intervals, log a more precise heading, or calibrate the gyroscope "
                      "by several complete turns",
                      100.0 * scale_std, 100.0 * kGyroScaleStd)};
}

}  // namespace

std::optional<Finding> widen_by_gyro_scale(const std::vector<DrivingLog>& logs, FamilyFit& chosen) {
  constexpr double kMuch = 1.5;
  constexpr double kLarge = 0.25 * kGyroScaleStd;
  LogFit& fit = chosen.fit;
  if (!fit.usable || !assumes_scale(fit)) return std::nullopt;
  auto solution = solution_of(logs, chosen);
  if (!solution) return std::nullopt;
  const auto open = open_scale(*std::move(solution));
  if (!open) return std::nullopt;
  Eigen::VectorXd change = open->std * open->by_scale;
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (!fit.refusal_reason[at(i)].empty()) change(i) = 0.0;
  }
  if (widen_by(change, fit) < kMuch || open->std < kLarge) return std::nullopt;
  return gyro_scale_finding(open->std, logs.front().file);
}

}  // namespace awmr
