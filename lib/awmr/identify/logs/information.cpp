#include "awmr/identify/logs/information.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// J_t - J_s (J_s^T J_s)^-1 J_s^T J_t: what the coordinates do that no initial state undoes.
Eigen::MatrixXd projected(const WindowResiduals& window, Eigen::Index n) {
  const Eigen::MatrixXd jt = window.jacobian.leftCols(n);
  const Eigen::MatrixXd js = window.jacobian.rightCols(window.jacobian.cols() - n);
  const Eigen::MatrixXd inner = (js.transpose() * js).ldlt().solve(js.transpose() * jt);
  return jt - js * inner;
}

std::vector<Eigen::VectorXd> scores_in(const FitWindow& window, const WindowResiduals& residuals,
                                       Eigen::Index n, double block_s) {
  std::vector<Eigen::VectorXd> blocks;
  const Eigen::MatrixXd rows = projected(residuals, n);
  const std::vector<double>& t_s = window.rows.log->t_s;
  double from_s = t_s[window.rows.begin];
  Eigen::VectorXd score = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < rows_of(window.samples); ++i) {
    const double now_s = t_s[window.samples[at(i)].row];
    if (now_s - from_s >= block_s) {
      blocks.push_back(score);
      score.setZero();
      from_s = now_s;
    }
    score += rows.row(i).transpose() * residuals.residuals(i);
  }
  blocks.push_back(score);
  return blocks;
}

}  // namespace

Eigen::MatrixXd information(const std::vector<WindowResiduals>& residuals, Eigen::Index n) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (const WindowResiduals& window : residuals) {
    const Eigen::MatrixXd jt = window.jacobian.leftCols(n);
    sum += projected(window, n).transpose() * jt;
  }
  return 0.5 * (sum + sum.transpose());
}

Scores scores_of(const std::vector<FitWindow>& windows,
                 const std::vector<WindowResiduals>& residuals, Eigen::Index n, double block_s) {
  Scores scores;
  const DrivingLog* log = nullptr;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (windows[w].rows.log != log) scores.logs.emplace_back(Eigen::VectorXd::Zero(n));
    log = windows[w].rows.log;
    for (Eigen::VectorXd& block : scores_in(windows[w], residuals[w], n, block_s)) {
      scores.logs.back() += block;
      scores.blocks.push_back(std::move(block));
    }
  }
  return scores;
}

double block_length_s(const NoiseLevels& noise) {
  double longest_s = 0.0;
  for (const auto& [channel, level] : noise) longest_s = std::max(longest_s, level.correlation_s);
  return std::clamp(5.0 * longest_s, 1.0, kWindow_s);
}

double akaike(const NoiseLevels& noise, Eigen::Index n) {
  double aic = 2.0 * static_cast<double>(n);
  for (const auto& [channel, level] : noise) {
    aic += level.cost + 2.0 * level.numbers();
  }
  return aic;
}

}  // namespace awmr
