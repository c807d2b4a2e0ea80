#include "repeated_logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

/// Fewest equal rows for a part in common, except exact copies.
constexpr std::size_t kMinEqual = 50;
constexpr double kNearlyAll = 0.95;  ///< minimum fraction of equal rows within the part in common
/// A row that occurs in the first log more often than this would agree at many time offsets, so it
/// does not help to find the offset between the two logs.
constexpr std::size_t kMaxAlike = 8;
constexpr std::size_t kMinCurve = 20;

/// Values of one quantity in two logs.
struct Pair {
  std::vector<double> a;
  std::vector<double> b;
  bool is_measured = false;
};

std::vector<double> without_turns(std::vector<double> angle_rad) {
  for (double& angle : angle_rad) angle = std::remainder(angle, 2.0 * pi<double>());
  return angle_rad;
}

/// Commands and measured channels that both logs have, without positions from latitude and
/// longitude, whose origin is the first row of each log.
std::vector<Pair> shared_values(const DrivingLog& a, const DrivingLog& b) {
  std::vector<Pair> pairs{{a.force_left, b.force_left}, {a.force_right, b.force_right}};
  for (const LogChannel channel : kChannels) {
    const bool is_position = channel == LogChannel::kX || channel == LogChannel::kY;
    if (!a[channel] || !b[channel]) continue;
    if (is_position && (a.is_geographic || b.is_geographic)) continue;
    Pair pair{a[channel]->value, b[channel]->value, true};
    if (channel == LogChannel::kHeading) {
      pair.a = without_turns(std::move(pair.a));
      pair.b = without_turns(std::move(pair.b));
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// Resolution of the values: the smallest difference between two values. Ignores differences of at
/// most 1e-9 of the range, which are due to rounding.
double resolution_of(std::vector<double> values) {
  std::ranges::sort(values);
  const double least = 1e-9 * (values.back() - values.front());
  double smallest = values.back() - values.front();
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1];
    if (difference > least) smallest = std::min(smallest, difference);
  }
  return smallest;
}

/// The rows of a log, with each value as a rounded multiple of its resolution.
struct RoundedRows {
  std::vector<std::vector<std::int64_t>> rows;
  /// For each row: true if a measurement differs from that of the previous row.
  std::vector<bool> changes;
};

RoundedRows rounded_rows(const std::vector<Pair>& pairs, const std::vector<double>& resolutions,
                         std::vector<double> Pair::*side) {
  RoundedRows found;
  const std::size_t count = (pairs.front().*side).size();
  for (std::size_t row = 0; row < count; ++row) {
    std::vector<std::int64_t> values;
    bool changes = false;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double value = (pairs[k].*side)[row];
      values.push_back(resolutions[k] > 0.0 ? std::llround(value / resolutions[k]) : 0);
      changes |= row > 0 && pairs[k].is_measured && values[k] != found.rows.back()[k];
    }
    found.rows.push_back(std::move(values));
    found.changes.push_back(changes);
  }
  return found;
}

/// Returns the time offset t_b - t_a, s, between the logs a and b for which most rows agree.
std::optional<double> likeliest_offset_s(const DrivingLog& a, const RoundedRows& of_a,
                                         const DrivingLog& b, const RoundedRows& of_b,
                                         double tolerance_s) {
  std::map<std::vector<std::int64_t>, std::vector<std::size_t>> places;
  for (std::size_t row = 0; row < of_a.rows.size(); ++row) {
    if (of_a.changes[row]) places[of_a.rows[row]].push_back(row);
  }
  std::map<std::int64_t, std::vector<double>> votes;
  for (std::size_t row = 0; row < of_b.rows.size(); ++row) {
    const auto found = places.find(of_b.rows[row]);
    if (!of_b.changes[row] || found == places.end() || found->second.size() > kMaxAlike) continue;
    for (const std::size_t other : found->second) {
      const double offset_s = b.t_s[row] - a.t_s[other];
      votes[std::llround(offset_s / tolerance_s)].push_back(offset_s);
    }
  }
  const auto most =
      std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second.size(); });
  if (most == votes.end()) return std::nullopt;
  return median(std::move(most->second));
}

std::size_t nearest_row(const DrivingLog& log, double t_s) {
  const auto after = std::ranges::lower_bound(log.t_s, t_s);
  if (after == log.t_s.begin()) return 0;
  const auto row = static_cast<std::size_t>(after - log.t_s.begin());
  if (after == log.t_s.end()) return row - 1;
  return t_s - log.t_s[row - 1] < *after - t_s ? row - 1 : row;
}

/// A part that two logs have in common: its first and its last row in each log.
struct CommonPart {
  std::size_t a_begin = 0;
  std::size_t a_end = 0;
  std::size_t b_begin = 0;
  std::size_t b_end = 0;
};

/// True if the part is at the beginning of both logs and covers less than 95 % of each.
bool is_common_start(const CommonPart& part, const DrivingLog& a, const DrivingLog& b) {
  constexpr std::size_t kFirst = 2;
  const double share_of_a = static_cast<double>(part.a_end + 1) / static_cast<double>(a.rows());
  const double share_of_b = static_cast<double>(part.b_end + 1) / static_cast<double>(b.rows());
  return part.a_begin < kFirst && part.b_begin < kFirst &&
         std::max(share_of_a, share_of_b) < kNearlyAll;
}

/// True if the logs have the same rows. Their times may differ by a constant offset.
bool is_copy(const DrivingLog& a, const DrivingLog& b, const std::vector<Pair>& pairs) {
  if (a.rows() != b.rows()) return false;
  if (!std::ranges::all_of(pairs, [](const Pair& pair) { return pair.a == pair.b; })) return false;
  const double span_s = a.t_s.back() - a.t_s.front();
  return std::abs(b.t_s.back() - b.t_s.front() - span_s) <= 1e-6 * span_s;
}

/// Extends the part in common over further equal rows at both ends: rows in which no measurement
/// changes (at rest, or the first row of a log).
CommonPart extended(CommonPart part, const RoundedRows& of_a, const RoundedRows& of_b) {
  while (part.a_begin > 0 && part.b_begin > 0 &&
         of_a.rows[part.a_begin - 1] == of_b.rows[part.b_begin - 1]) {
    --part.a_begin;
    --part.b_begin;
  }
  while (part.a_end + 1 < of_a.rows.size() && part.b_end + 1 < of_b.rows.size() &&
         of_a.rows[part.a_end + 1] == of_b.rows[part.b_end + 1]) {
    ++part.a_end;
    ++part.b_end;
  }
  return part;
}

std::optional<CommonPart> common_part(const DrivingLog& a, const DrivingLog& b) {
  const std::vector<Pair> pairs = shared_values(a, b);
  if (is_copy(a, b, pairs)) return CommonPart{0, a.rows() - 1, 0, b.rows() - 1};
  std::vector<double> resolutions;
  for (const Pair& pair : pairs) {
    resolutions.push_back(std::max(resolution_of(pair.a), resolution_of(pair.b)));
  }
  const RoundedRows of_a = rounded_rows(pairs, resolutions, &Pair::a);
  const RoundedRows of_b = rounded_rows(pairs, resolutions, &Pair::b);
  const double tolerance_s = 0.5 * std::min(a.median_step_s(), b.median_step_s());
  const auto offset_s = likeliest_offset_s(a, of_a, b, of_b, tolerance_s);
  if (!offset_s) return std::nullopt;

  std::vector<std::pair<std::size_t, std::size_t>> equal;
  std::vector<bool> is_equal;  // by compared row
  for (std::size_t row = 0; row < b.rows(); ++row) {
    const std::size_t other = nearest_row(a, b.t_s[row] - *offset_s);
    const bool is_compared = std::abs(b.t_s[row] - *offset_s - a.t_s[other]) <= tolerance_s;
    if (!is_compared || !of_b.changes[row]) continue;
    is_equal.push_back(of_a.rows[other] == of_b.rows[row]);
    if (is_equal.back()) equal.emplace_back(other, row);
  }
  if (equal.size() < kMinEqual) return std::nullopt;
  // Rows before the first and after the last equal row are not in the common part.
  const auto first = std::ranges::find(is_equal, true);
  const auto last = std::find(is_equal.rbegin(), is_equal.rend(), true).base();
  if (static_cast<double>(equal.size()) < kNearlyAll * static_cast<double>(last - first)) {
    return std::nullopt;
  }
  return extended({.a_begin = equal.front().first,
                   .a_end = equal.back().first,
                   .b_begin = equal.front().second,
                   .b_end = equal.back().second},
                  of_a, of_b);
}

}  // namespace

void check_repeated_logs(const std::vector<DrivingLog>& logs, std::vector<Fault>& faults) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto part = common_part(logs[k], logs[i]);
      if (!part || is_common_start(*part, logs[k], logs[i])) continue;
      faults.push_back(
          {ErrorCode::kGivenTwice, logs[i].file,
           fmt::format("lines {} to {} are the same recording as lines {} to {} of {}, so it would "
                       "count twice; remove one of the two files, or these lines from one of them",
                       logs[i].line[part->b_begin], logs[i].line[part->b_end],
                       logs[k].line[part->a_begin], logs[k].line[part->a_end], logs[k].file)});
      break;
    }
  }
}

void check_repeated_curves(const std::vector<CoastCurve>& curves, std::vector<Fault>& faults) {
  const auto is_copy = [](const CoastCurve& a, const CoastCurve& b) {
    if (a.speed_mps.size() < kMinCurve || a.speed_mps != b.speed_mps) return false;
    const double span_s = a.t_s.back() - a.t_s.front();
    return std::abs(b.t_s.back() - b.t_s.front() - span_s) < 1e-6 * span_s;
  };
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!is_copy(curves[k], curves[i])) continue;
      faults.push_back(
          {ErrorCode::kGivenTwice, curves[i].file,
           fmt::format("the coast-down from line {} is the same recording as that from line {} "
                       "of {}, so it would count twice; remove one of the two recordings",
                       curves[i].line, curves[k].line, curves[k].file)});
      break;
    }
  }
}

}  // namespace awmr
