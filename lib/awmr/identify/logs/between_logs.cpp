#include "awmr/identify/logs/between_logs.h"

#include <fmt/format.h>

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

template <class T>
std::vector<T> part_of(const std::vector<T>& all, std::size_t first, std::size_t last) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first),
          all.begin() + static_cast<std::ptrdiff_t>(last)};
}

/// Rows [first, last) of a log under a name of their own.
DrivingLog rows_between(const DrivingLog& log, std::size_t first, std::size_t last,
                        const std::string& which) {
  DrivingLog part = log;
  part.file = fmt::format("the {} of {}", which, log.file);
  part.line = part_of(log.line, first, last);
  part.t_s = part_of(log.t_s, first, last);
  part.force_left = part_of(log.force_left, first, last);
  part.force_right = part_of(log.force_right, first, last);
  if (part.steering_command_rad) {
    part.steering_command_rad = part_of(*log.steering_command_rad, first, last);
  }
  for (std::optional<Measured>& measured : part.measured) {
    if (!measured) continue;
    measured->value = part_of(std::vector<double>(measured->value), first, last);
    measured->fresh = part_of(std::vector<bool>(measured->fresh), first, last);
    measured->fresh_count =
        static_cast<int>(std::count(measured->fresh.begin(), measured->fresh.end(), true));
  }
  return part;
}

/// The logs, or the halves of a single one that is long enough for each to show something.
std::vector<DrivingLog> parts_to_compare(const std::vector<DrivingLog>& logs) {
  constexpr double kLongEnough_s = 20.0;
  if (logs.size() > 1) return logs;
  const DrivingLog& log = logs.front();
  const double duration_s = log.t_s.back() - log.t_s.front();
  if (duration_s < kLongEnough_s) return {};
  const auto middle = std::ranges::lower_bound(log.t_s, log.t_s.front() + 0.5 * duration_s);
  const auto half = static_cast<std::size_t>(middle - log.t_s.begin());
  return {rows_between(log, 0, half, "first half"),
          rows_between(log, half, log.rows(), "second half")};
}

}  // namespace

std::vector<LogDisagreement> hold_against_each_other(const std::vector<DrivingLog>& all,
                                                     FamilyFit& common) {
  constexpr double kLevel = 0.001;
  std::vector<LogDisagreement> disagreements;
  if (!common.fit.usable) return disagreements;
  const std::vector<DrivingLog> logs = parts_to_compare(all);
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
