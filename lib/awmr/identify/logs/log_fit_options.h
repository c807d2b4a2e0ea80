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

/// Work of all searches of one identification: numbers integrated, each state and each derivative
/// at each step. Unlike a time, it does not depend on the machine or its load.
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
  /// By ParameterId: where the search begins, and what a parameter that is not free is held at.
  ParameterValues<double> initial_guess{};
  /// Free parameters whose initial guess is an order of magnitude: the multistart draws these anew.
  /// Empty where other trials gave every initial guess, and one search is enough.
  std::vector<ParameterId> guessed;
  std::vector<ParameterId> free;
  /// Terms held at 0 whose worth the fit estimates without freeing them.
  std::vector<ParameterId> candidate_terms;
  /// Delays, lags and errors that are free. No lag of the motors where the vehicle file gives it: it is
  /// held there then.
  std::vector<FreeTerm> terms;
  std::vector<LogChannel> biases;  ///< channels whose constant offset is free
  bool finds_delays = true;        ///< the fit adds the terms that its residuals show
  /// Time of the rows that are fitted, s; the commands before them act on them all the same,
  /// through latency and lags. Absent: all rows.
  std::optional<Interval> only_s;
  /// Further initial guesses: the optimum of a family inside this one.
  std::vector<ParameterValues<double>> also_from;
  Loss loss = Loss::kSquared;  ///< a robust one where a sensor has outliers
  std::uint64_t seed = 1;      ///< of the multistart and of the bootstrap
  int multistart = 6;          ///< random initial guesses in addition to the given one
  int bootstrap = 0;           ///< resamples of the block bootstrap; 0: none
  int threads = 0;             ///< 0: every core; the result does not depend on it
  /// Counts the work of the searches; once it is over, no further model is tried. Absent: no limit.
  std::shared_ptr<Effort> effort;
  /// When every search stops where it is.
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

}  // namespace awmr
