#include "awmr/identify/logs/between_logs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/core/distributions.h"
#include "awmr/core/index.h"
#include "awmr/identify/uncertainty/quantiles.h"

namespace awmr {
namespace {

/// One quantity as single logs show it.
struct ByLog {
  std::vector<std::string> files;
  std::vector<double> coordinates;
  std::vector<double> weights;  ///< 1/variance
};

/// Where a fit has a quantity that it shows.
std::optional<std::size_t> place_in(const LogFit& fit, const std::string& name) {
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    if (fit.quantities[i].name() == name && fit.why_not[i].empty()) return i;
  }
  return std::nullopt;
}

ByLog collect(const std::vector<DrivingLog>& logs, const std::vector<LogFit>& fits,
              const std::string& name) {
  ByLog found;
  for (std::size_t l = 0; l < fits.size(); ++l) {
    const auto place = fits[l].usable ? place_in(fits[l], name) : std::nullopt;
    if (!place) continue;
    const Eigen::Index i = eigen_index(*place);
    found.files.push_back(logs[l].file);
    found.coordinates.push_back(fits[l].coordinates[*place]);
    found.weights.push_back(1.0 / fits[l].covariance(i, i));
  }
  return found;
}

/// What the logs' values of one quantity say of its being one.
struct Heterogeneity {
  double p_value = 1.0;
  double widening = 1.0;  ///< of the standard error, for the mean of such vehicles
};

Heterogeneity heterogeneity(const ByLog& by_log) {
  double sum = 0.0;
  double squares = 0.0;
  double mean = 0.0;
  for (std::size_t l = 0; l < by_log.weights.size(); ++l) {
    sum += by_log.weights[l];
    squares += by_log.weights[l] * by_log.weights[l];
    mean += by_log.weights[l] * by_log.coordinates[l];
  }
  mean /= sum;
  double q = 0.0;
  for (std::size_t l = 0; l < by_log.weights.size(); ++l) {
    q += by_log.weights[l] * std::pow(by_log.coordinates[l] - mean, 2);
  }
  const double degrees = static_cast<double>(by_log.weights.size()) - 1.0;
  const double between = std::max(0.0, (q - degrees) / (sum - squares / sum));
  return {chi_squared_tail(q, degrees), std::sqrt(1.0 + between * squares / sum)};
}

/// Widens the i-th quantity of the common fit, known from this many logs.
void widen(std::size_t i, double by, std::size_t logs, LogFit& fit) {
  const Eigen::Index row = eigen_index(i);
  fit.covariance.row(row) *= by;
  fit.covariance.col(row) *= by;
  const FreeQuantity& q = fit.quantities[i];
  const double x = fit.coordinates[i];
  const double error = std::sqrt(fit.covariance(row, row));
  const double half = t_quantile_95(static_cast<double>(logs) - 1.0) * error;
  EstimatorParameter& parameter = fit.report.parameters[i];
  parameter.std_error = q.jacobian(x) * error;
  parameter.ci95 = Interval{q.value(x - half), q.value(x + half)};
}

}  // namespace

std::vector<LogDisagreement> hold_against_each_other(const std::vector<DrivingLog>& logs,
                                                     FamilyFit& common) {
  constexpr double kLevel = 0.001;
  std::vector<LogDisagreement> disagreements;
  if (logs.size() < 2 || !common.fit.usable) return disagreements;
  LogFitOptions options = from_optimum(common.options, common);
  options.bootstrap = 0;
  std::vector<LogFit> fits;
  fits.reserve(logs.size());
  for (const DrivingLog& log : logs) fits.push_back(fit_logs({log}, options));
  const double level = kLevel / static_cast<double>(common.fit.quantities.size());
  for (std::size_t i = 0; i < common.fit.quantities.size(); ++i) {
    const FreeQuantity& q = common.fit.quantities[i];
    if (q.kind == FreeQuantity::Kind::kBias || !common.fit.why_not[i].empty()) continue;
    const ByLog by_log = collect(logs, fits, q.name());
    if (by_log.files.size() < 2) continue;
    const Heterogeneity between = heterogeneity(by_log);
    if (!(between.p_value < level)) continue;
    widen(i, between.widening, by_log.files.size(), common.fit);
    LogDisagreement one{q.name(), between.p_value, by_log.files, {}};
    for (const double x : by_log.coordinates) one.values.push_back(q.value(x));
    disagreements.push_back(one);
  }
  return disagreements;
}

}  // namespace awmr
