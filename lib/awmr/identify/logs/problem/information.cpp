#include "awmr/identify/logs/problem/information.h"

#include <algorithm>

#include "awmr/core/statistics/linear_algebra.h"

namespace awmr {
namespace {

/// Change of a window's initial state that best compensates a change of each coordinate: (J_s^T
/// J_s)^-1 J_s^T J_t (symbols of FitEvidence).
Eigen::MatrixXd compensation(const WindowSums& window, Eigen::Index n) {
  const Eigen::Index k = window.products.rows() - 1 - n;
  return solve_ldlt(window.products.block(n, n, k, k), window.products.block(n, 0, k, n));
}

/// Score of the coordinates after elimination of a window's initial state. `gradient`: g_t, then
/// g_s (symbols of FitEvidence). `by_initial`: J_t^T J_s (J_s^T J_s)^-1 of the window.
Eigen::VectorXd score(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& by_initial) {
  const Eigen::Index n = by_initial.rows();
  return gradient.head(n) - by_initial * gradient.segment(n, by_initial.cols());
}

}  // namespace

FitEvidence fit_evidence(const std::vector<WindowSums>& sums, Eigen::Index n) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd total = Eigen::VectorXd::Zero(n);
  for (const WindowSums& window : sums) {
    const Eigen::MatrixXd by_coordinate = compensation(window, n);
    const Eigen::Index k = by_coordinate.rows();
    information +=
        window.products.topLeftCorner(n, n) - window.products.block(0, n, n, k) * by_coordinate;
    total += score(window.products.col(window.products.cols() - 1), by_coordinate.transpose());
  }
  return {0.5 * (information + information.transpose()), total};
}

Scores scores_of(const std::vector<FitWindow>& windows, const std::vector<WindowSums>& sums,
                 Eigen::Index n) {
  Scores scores;
  const DrivingLog* log = nullptr;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (windows[w].rows.log != log) scores.logs.emplace_back(Eigen::VectorXd::Zero(n));
    log = windows[w].rows.log;
    const Eigen::MatrixXd by_initial = compensation(sums[w], n).transpose();
    for (const Eigen::VectorXd& gradient : sums[w].block_gradients) {
      scores.blocks.push_back(score(gradient, by_initial));
      scores.logs.back() += scores.blocks.back();
    }
  }
  return scores;
}

double block_length_s(const NoiseLevels& noise) {
  double longest_s = 0.0;
  for (const auto& [sensor, level] : noise) longest_s = std::max(longest_s, level.correlation_s);
  return std::clamp(5.0 * longest_s, 1.0, kWindow_s);
}

}  // namespace awmr
