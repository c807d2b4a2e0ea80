#include "repeated_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "awmr/core/units.h"

namespace awmr {
namespace {

/// The check reports k repeated rows if the probability of k or more repeats by chance is at most
/// this.
constexpr double kChance = 0.01;
/// Minimum degrees of freedom for an estimate of the scatter from rows with equal settings.
constexpr int kMinDifferences = 3;
/// If one unit in the last decimal place of the readings is less than this fraction of the largest
/// reading, the readings were computed, not read. Their last place is then not their resolution.
constexpr double kComputed = 1e-6;

/// Probability p of CHECKS.md that two readings are the same by chance.
double chance_of_same(double q, double s) {
  const double a = q / (2.0 * s);
  // For small a the two terms below cancel numerically; p is then a/sqrt(pi), with an error below
  // a^3/10.
  if (a < 1e-3) return a / std::sqrt(pi<double>());
  return std::erf(a) - (1.0 - std::exp(-a * a)) / (a * std::sqrt(pi<double>()));
}

/// Probability of k or more for a Poisson variable with mean `expected`; 1 if k <= `expected`.
double chance_of_so_many(double expected, int k) {
  if (k <= expected) return 1.0;
  // Sum of L^j e^-L / j! over j >= k, with L = `expected`. Each term is L/(j + 1) times the term
  // before it.
  double term = std::exp(k * std::log(expected) - expected - std::lgamma(k + 1.0));
  double sum = 0.0;
  for (int j = k; term > 1e-6 * sum; ++j) {
    sum += term;
    term *= expected / (j + 1.0);
  }
  return sum;
}

/// Runs with equal settings: their rows in order, and the reading of each.
struct LikeRuns {
  std::vector<std::size_t> rows;
  std::vector<double> readings;
};

/// Returns the column of the compared readings: `timed` or else `printed`, if it has a value in all
/// rows.
std::optional<std::string_view> reading_of(const TrialReader& reader,
                                           const std::vector<std::size_t>& rows,
                                           const RepeatRule& rule) {
  for (const std::string_view column : {rule.timed, rule.printed}) {
    const bool all = std::ranges::all_of(
        rows, [&](std::size_t row) { return reader.cell(row, column).value_or(0.0) != 0.0; });
    if (all) return column;
  }
  return std::nullopt;
}

std::vector<LikeRuns> like_runs(const TrialReader& reader, const std::vector<std::size_t>& rows,
                                const RepeatRule& rule, std::string_view reading) {
  std::map<std::vector<std::optional<double>>, LikeRuns> groups;
  for (const std::size_t row : rows) {
    std::vector<std::optional<double>> settings;
    for (const std::string_view column : rule.settings) {
      settings.push_back(reader.cell(row, column));
    }
    LikeRuns& group = groups[settings];
    group.rows.push_back(row);
    group.readings.push_back(std::abs(*reader.cell(row, reading)));
  }
  std::vector<LikeRuns> found;
  found.reserve(groups.size());
  for (auto& [settings, group] : groups) found.push_back(std::move(group));
  return found;
}

/// Relative standard deviation of the readings of runs with equal settings. Equal readings count
/// once. Empty with fewer than kMinDifferences degrees of freedom.
std::optional<double> scatter_seen(const std::vector<LikeRuns>& groups) {
  double squares = 0.0;
  int differences = 0;
  for (const LikeRuns& group : groups) {
    const std::set<double> distinct(group.readings.begin(), group.readings.end());
    if (distinct.size() < 2) continue;
    double mean = 0.0;
    for (const double value : distinct) mean += value / static_cast<double>(distinct.size());
    for (const double value : distinct) squares += (value / mean - 1.0) * (value / mean - 1.0);
    differences += static_cast<int>(distinct.size()) - 1;
  }
  if (differences < kMinDifferences) return std::nullopt;
  return std::sqrt(squares / differences);
}

/// Resolution q of the readings: one unit in their last decimal place. For readings that were
/// computed, it is the smallest difference between two of them.
double resolution_of(const TrialReader& reader, std::string_view reading,
                     const std::vector<LikeRuns>& groups) {
  std::set<double> values;
  for (const LikeRuns& group : groups) values.insert(group.readings.begin(), group.readings.end());
  const double last_place = reader.last_place(reading);
  if (last_place > kComputed * *values.rbegin()) return last_place;
  double least = *values.rbegin();
  for (auto value = values.begin(); std::next(value) != values.end(); ++value) {
    least = std::min(least, *std::next(value) - *value);
  }
  return least;
}

}  // namespace

void find_repeated_rows(const TrialReader& reader, const std::vector<std::size_t>& rows,
                        const RepeatRule& rule, std::vector<Finding>& findings) {
  if (rows.size() < 2) return;
  const auto reading = reading_of(reader, rows, rule);
  if (!reading) return;
  const std::vector<LikeRuns> groups = like_runs(reader, rows, rule, *reading);
  const double resolution = resolution_of(reader, *reading, groups);
  const auto seen = scatter_seen(groups);
  std::vector<std::size_t> repeated;
  double expected = 0.0;
  for (const LikeRuns& group : groups) {
    std::set<std::pair<double, std::optional<double>>> before;
    for (std::size_t i = 0; i < group.rows.size(); ++i) {
      const double value = group.readings[i];
      const double scatter = value * (seen ? std::min(rule.scatter, *seen) : rule.scatter);
      expected +=
          std::min(1.0, static_cast<double>(before.size()) * chance_of_same(resolution, scatter));
      const bool is_new = before.insert({value, reader.cell(group.rows[i], rule.printed)}).second;
      if (!is_new) repeated.push_back(group.rows[i]);
    }
  }
  const int count = static_cast<int>(repeated.size());
  if (count == 0 || chance_of_so_many(expected, count) > kChance) return;
  std::ranges::sort(repeated);
  findings.push_back(reader.finding(
      repeated.front(), Severity::kWarning, "repeated-rows",
      fmt::format("{} of {} rows repeat an earlier row to the last digit of {} ({}); with "
                  "readings in steps of {:.2g}, about {:.2g} rows repeat by chance. Copies make "
                  "every confidence interval too narrow: delete rows that are not separate runs",
                  repeated.size(), rows.size(), *reading, lines_of(reader, repeated), resolution,
                  expected)));
}

}  // namespace awmr
