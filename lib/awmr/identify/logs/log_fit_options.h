/// Options of fit_logs(). Private to identify/.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/identify/logs/quantities.h"
#include "awmr/identify/options.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Work of all searches of one identification: number of integrated states and derivatives, summed
/// over the steps. Unlike a time, it does not depend on the machine or its load.
class Effort {
 public:
  explicit Effort(std::int64_t limit) : limit_(limit) {}
  void add(std::int64_t numbers) { spent_ += numbers; }
  bool is_over() const { return spent_ > limit_; }
  std::int64_t spent() const { return spent_; }
  std::int64_t left() const { return std::max<std::int64_t>(0, limit_ - spent_); }

 private:
  std::int64_t limit_;
  std::atomic<std::int64_t> spent_ = 0;
};

struct LogFitOptions {
  Vehicle vehicle;
  /// By ParameterId: initial guess of a free parameter, value of a fixed one.
  ParameterValues<double> initial_guess{};
  /// Free parameters whose initial guess is only an order of magnitude; the multistart varies them.
  /// Empty if other trials gave every initial guess, so that one search suffices.
  std::vector<ParameterId> guessed;
  std::vector<ParameterId> free;
  /// Terms fixed at 0, for which the fit computes a score test.
  std::vector<ParameterId> candidate_terms;
  /// Free delays, lags and command errors. Excludes a motor lag from the vehicle file, which is
  /// fixed.
  std::vector<FreeTerm> terms;
  std::vector<LogChannel> biases;  ///< channels whose constant offset is free
  bool finds_delays = true;        ///< the fit adds significant terms (delays.h)
  /// Time of the fitted rows, s. Commands before it act on them through latency and lags. Absent:
  /// all rows.
  std::optional<Interval> only_s;
  /// Further initial guesses, such as the optimum of a family that this one contains.
  std::vector<ParameterValues<double>> also_from;
  Loss loss = Loss::kSquared;  ///< robust if a sensor has outliers
  std::uint64_t seed = 1;      ///< of the multistart and of the bootstrap
  int multistart = 6;          ///< random initial guesses in addition to the given one
  int bootstrap = 0;           ///< resamples of the block bootstrap; 0: none
  int threads = 0;             ///< 0: every core; the result does not depend on it
  /// Counts the work of the searches. At its limit no further model is fitted. Absent: no limit.
  std::shared_ptr<Effort> effort;
  /// Time at which all searches stop.
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

}  // namespace awmr
