#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/trials/checks/log_evidence.h"

namespace awmr {
namespace {

/// A change between two readings is a jump if it exceeds kTimes times the usual change for the time
/// between them. The usual change per second is the quantile kQuantile of all changes per second:
/// the jumps themselves, if they are rare, do not affect this quantile.
constexpr double kTimes = 10.0;
constexpr double kQuantile = 0.95;
/// Smallest jump of the position that is reported, in vehicle lengths. A smaller jump may be a
/// correction by the position receiver.
constexpr double kVehicleLengths = 4.0;
constexpr double kMinTurn_rad = 1.0;
constexpr std::size_t kMin = 20;

struct Move {
  std::size_t from = 0;  ///< row of the first reading
  std::size_t to = 0;    ///< row of the second reading
  double span_s = 0.0;   ///< time between the two readings
  double size = 0.0;     ///< magnitude of the change, m or rad
};

/// Function `size(a, b)` that returns the distance between the readings in the rows a and b.
using Size = std::function<double(std::size_t, std::size_t)>;

std::vector<Move> moves_between(const DrivingLog& log, const std::vector<std::size_t>& rows,
                                const Size& size) {
  std::vector<Move> moves;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double span_s = log.t_s[rows[i]] - log.t_s[rows[i - 1]];
    moves.push_back({rows[i - 1], rows[i], span_s, size(rows[i - 1], rows[i])});
  }
  return moves;
}

double common_rate(const std::vector<Move>& moves) {
  std::vector<double> rates;
  for (const Move& move : moves) rates.push_back(move.size / move.span_s);
  return quantile(std::move(rates), kQuantile);
}

/// Returns the first jump: a single change of more than kTimes times the usual change, after which
/// the signal does not return. `least`: smallest change that counts as a jump. Empty without a
/// jump, or with fewer than kMin changes.
std::optional<Move> jump_in(const std::vector<Move>& moves, double least, const Size& size) {
  if (moves.size() < kMin) return std::nullopt;
  const double rate = common_rate(moves);
  const auto is_far = [&](const Move& move) {
    return move.size > std::max(least, kTimes * rate * move.span_s);
  };
  for (std::size_t i = 1; i + 1 < moves.size(); ++i) {
    const Move& next = moves[i + 1];
    const bool stays = !is_far(moves[i - 1]) && !is_far(next);
    if (is_far(moves[i]) && stays && size(moves[i].from, next.to) > 0.5 * moves[i].size) {
      return moves[i];
    }
  }
  return std::nullopt;
}

std::vector<std::size_t> rows_with(const DrivingLog& log, std::initializer_list<LogChannel> all) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (std::ranges::all_of(all, [&](LogChannel c) { return log[c]->fresh[row]; })) {
      rows.push_back(row);
    }
  }
  return rows;
}

/// Detects a jump from or to the position (0, 0), which a receiver without a fix writes.
std::optional<Contradiction> zero_fix(const DrivingLog& log, const Move& jump) {
  const std::vector<double>& x = log[LogChannel::kX]->value;
  const std::vector<double>& y = log[LogChannel::kY]->value;
  const auto is_zero = [&](std::size_t row) { return x[row] == 0.0 && y[row] == 0.0; };
  constexpr std::size_t kMinZeros = 3;
  const std::size_t zero = is_zero(jump.to) ? jump.to : jump.from;
  std::size_t rows = 0;
  for (std::size_t row = 0; row < log.rows(); ++row) rows += is_zero(row) ? 1U : 0U;
  if (!is_zero(zero) || rows < kMinZeros) return std::nullopt;
  return Contradiction{"x_m",
                       fmt::format("x_m and y_m are both exactly 0 in {} rows (such as line {}), "
                                   "{:.3g} m from the next reading: a receiver without a fix. "
                                   "Leave these cells empty",
                                   rows, log.line[zero], jump.size),
                       ""};
}

Contradiction described(const DrivingLog& log, const Move& jump, std::string column,
                        const std::string& how_far) {
  return {std::move(column),
          fmt::format(
              "it jumps by {} between lines {} and {}, within {:.3g} s: this looks like two runs "
              "in one file; number the runs in a column run, or give each run a file of its own",
              how_far, log.line[jump.from], log.line[jump.to], jump.span_s),
          ""};
}

}  // namespace

std::optional<Contradiction> jump_contradiction(const Evidence& evidence) {
  const DrivingLog& log = evidence.log;
  if (evidence.has(LogChannel::kX) && evidence.has(LogChannel::kY)) {
    const std::vector<double>& x = log[LogChannel::kX]->value;
    const std::vector<double>& y = log[LogChannel::kY]->value;
    const Size size = [&](std::size_t a, std::size_t b) {
      return std::hypot(x[b] - x[a], y[b] - y[a]);
    };
    const auto moves = moves_between(log, rows_with(log, {LogChannel::kX, LogChannel::kY}), size);
    const auto jump = jump_in(moves, kVehicleLengths * evidence.vehicle.length_m, size);
    if (jump) {
      if (auto zeros = zero_fix(log, *jump)) return zeros;
      return described(log, *jump, "x_m", fmt::format("{:.3g} m (x_m and y_m)", jump->size));
    }
  }
  if (!evidence.has(LogChannel::kHeading)) return std::nullopt;
  const std::vector<double>& heading = log[LogChannel::kHeading]->value;
  const Size size = [&](std::size_t a, std::size_t b) { return std::abs(heading[b] - heading[a]); };
  const auto moves = moves_between(log, rows_with(log, {LogChannel::kHeading}), size);
  const auto jump = jump_in(moves, kMinTurn_rad, size);
  if (!jump) return std::nullopt;
  constexpr double kAboutHalfATurn_rad = radians(20.0);
  if (std::abs(jump->size - pi<double>()) < kAboutHalfATurn_rad) {
    return Contradiction{
        "heading_deg",
        fmt::format(
            "it jumps by {:.3g} deg between lines {} and {}, within {:.3g} s: the course of a "
            "GPS while the vehicle rolls backward, or two runs in one file; leave the cells "
            "of backward motion empty, or number the runs in a column run",
            degrees(jump->size), log.line[jump->from], log.line[jump->to], jump->span_s),
        ""};
  }
  return described(log, *jump, "heading_deg", fmt::format("{:.3g} deg", degrees(jump->size)));
}

}  // namespace awmr
