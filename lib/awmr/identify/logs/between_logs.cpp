#include "awmr/identify/logs/between_logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

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

/// Index of a quantity in a fit; none if the fit does not identify it.
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

/// Tests whether the logs' values of one quantity agree.
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

/// The rows of a log from this share of its duration on.
DrivingLog rows_from(const DrivingLog& log, double share, const std::string& which) {
  const double begin_s = log.t_s.front() + share * (log.t_s.back() - log.t_s.front());
  const auto first = std::ranges::lower_bound(log.t_s, begin_s) - log.t_s.begin();
  return rows_between(log, static_cast<std::size_t>(first), log.rows(), which);
}

std::vector<LogDisagreement> disagreements_of(const std::vector<DrivingLog>& logs,
                                              const std::vector<LogFit>& fits, FamilyFit& common) {
  constexpr double kLevel = 0.001;
  std::vector<LogDisagreement> disagreements;
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

LogComparison compare_parts(const DrivingLog& log, const LogFitOptions& options,
                            FamilyFit& common) {
  constexpr double kAgree = 0.05;
  constexpr double kMiss = 0.001;
  LogComparison found;
  const DrivingLog second = rows_from(log, 0.5, "second half");
  const DrivingLog first = rows_between(log, 0, log.rows() - second.rows(), "first half");
  LogFit by_first = fit_logs({first}, options);
  if (!by_first.usable) return found;
  const auto second_half = predict(second, by_first, options);
  const auto last_fifth = predict(rows_from(log, 0.8, "last fifth"), by_first, options);
  const auto agrees = [](const std::optional<HeldOut>& rows) {
    return rows && rows->p_value > kAgree;
  };
  if (agrees(second_half) && agrees(last_fifth)) return found;
  found.disagreements =
      disagreements_of({first, second}, {std::move(by_first), fit_logs({second}, options)}, common);
  const bool misses = last_fifth && last_fifth->p_value < kMiss;
  if (found.disagreements.empty() && misses) found.missed = last_fifth;
  return found;
}

}  // namespace

LogComparison compare_logs(const std::vector<DrivingLog>& logs, FamilyFit& common) {
  constexpr double kLongEnough_s = 20.0;  // for each half to show something
  if (!common.fit.usable) return {};
  LogFitOptions options = from_optimum(common.options, common);
  options.bootstrap = 0;
  const DrivingLog& log = logs.front();
  if (logs.size() == 1) {
    if (log.t_s.back() - log.t_s.front() < kLongEnough_s) return {};
    return compare_parts(log, options, common);
  }
  std::vector<LogFit> fits;
  fits.reserve(logs.size());
  for (const DrivingLog& one : logs) fits.push_back(fit_logs({one}, options));
  return {disagreements_of(logs, fits, common), std::nullopt};
}

}  // namespace awmr
