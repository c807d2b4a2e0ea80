#include "awmr/identify/logs/between_logs.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <optional>

#include "awmr/core/index.h"
#include "awmr/identify/logs/information.h"

namespace awmr {
namespace {

/// What one log says on its own.
struct OneLog {
  std::string file;
  Eigen::VectorXd step;      ///< from the common coordinates to its own
  Eigen::VectorXd variance;  ///< of its own coordinates
};

OneLog one_log(const std::string& file, const std::vector<FitWindow>& windows,
               const std::vector<WindowResiduals>& residuals, const Eigen::VectorXd& scale) {
  const Eigen::Index n = scale.size();
  Eigen::MatrixXd scaled = scale.asDiagonal() * information(residuals, n) * scale.asDiagonal();
  scaled.diagonal().array() += 1.0 / (kPriorStd * kPriorStd);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  for (const Eigen::VectorXd& score : block_scores(windows, residuals, n, kWindow_s)) {
    gradient += scale.cwiseProduct(score);
  }
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  return {file, -scale.cwiseProduct(inverse * gradient),
          scale.cwiseAbs2().cwiseProduct(inverse.diagonal())};
}

std::vector<OneLog> by_log(const LogProblem& problem, const std::vector<WindowResiduals>& residuals,
                           const Eigen::VectorXd& scale) {
  std::vector<OneLog> logs;
  for (std::size_t begin = 0; begin < problem.windows.size();) {
    const DrivingLog* const log = problem.windows[begin].rows.log;
    std::size_t end = begin;
    while (end < problem.windows.size() && problem.windows[end].rows.log == log) ++end;
    const auto from = eigen_index(begin);
    const auto to = eigen_index(end);
    logs.push_back(one_log(log->file,
                           {problem.windows.begin() + from, problem.windows.begin() + to},
                           {residuals.begin() + from, residuals.begin() + to}, scale));
    begin = end;
  }
  return logs;
}

/// Quantity i over the logs that show it; none where fewer than two do or they agree.
std::optional<LogDisagreement> disagreement_of(const std::vector<OneLog>& logs, Eigen::Index i,
                                               double scale, double coordinate, double widened,
                                               double level) {
  constexpr double kShown = 0.5;  // of the large change, as for all logs together
  LogDisagreement found;
  found.quantity = at(i);
  double sum = 0.0;
  double squares = 0.0;
  double mean = 0.0;
  std::vector<double> weights;
  for (const OneLog& log : logs) {
    const double variance = widened * widened * log.variance(i);
    if (!(std::sqrt(variance) < kShown * scale)) continue;
    found.files.push_back(log.file);
    found.coordinates.push_back(coordinate + log.step(i));
    weights.push_back(1.0 / variance);
    sum += weights.back();
    squares += weights.back() * weights.back();
    mean += weights.back() * found.coordinates.back();
  }
  if (weights.size() < 2) return std::nullopt;
  mean /= sum;
  double q = 0.0;
  for (std::size_t l = 0; l < weights.size(); ++l) {
    q += weights[l] * std::pow(found.coordinates[l] - mean, 2);
  }
  const double degrees = static_cast<double>(weights.size()) - 1.0;
  found.p_value = boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees), q));
  if (!(found.p_value < level)) return std::nullopt;
  const double between = std::max(0.0, (q - degrees) / (sum - squares / sum));
  found.between_std = std::sqrt(between);
  found.widening = std::sqrt(1.0 + between * squares / sum);
  return found;
}

}  // namespace

std::vector<LogDisagreement> log_disagreements(const LogProblem& problem,
                                               const std::vector<WindowResiduals>& residuals,
                                               const std::vector<double>& coordinates,
                                               const Identifiability& found) {
  constexpr double kLevel = 0.001;
  std::vector<LogDisagreement> disagreements;
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const Eigen::Index n = rows_of(quantities);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale(i) = quantities[at(i)].large_change;
  const std::vector<OneLog> logs = by_log(problem, residuals, scale);
  if (logs.size() < 2) return disagreements;
  for (Eigen::Index i = 0; i < n; ++i) {
    // A sensor's bias may be another in every log.
    if (quantities[at(i)].kind == FreeQuantity::Kind::kBias || !found.why_not[at(i)].empty())
      continue;
    const auto one = disagreement_of(logs, i, scale(i), coordinates[at(i)], found.factor[at(i)],
                                     kLevel / static_cast<double>(n));
    if (one) disagreements.push_back(*one);
  }
  return disagreements;
}

Identifiability with_disagreements(Identifiability found,
                                   const std::vector<LogDisagreement>& disagreements) {
  for (const LogDisagreement& one : disagreements) {
    const Eigen::Index i = eigen_index(one.quantity);
    found.covariance.row(i) *= one.widening;
    found.covariance.col(i) *= one.widening;
    found.degrees_of_freedom[one.quantity] = std::min(found.degrees_of_freedom[one.quantity],
                                                      static_cast<double>(one.files.size()) - 1.0);
  }
  return found;
}

}  // namespace awmr
