/// Options of a log fit, fit_logs(). Private to identify/.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/core/containers.h"
#include "awmr/identify/logs/problem/channel_noise.h"
#include "awmr/identify/logs/problem/quantities.h"
#include "awmr/identify/logs/problem/windows.h"
#include "awmr/identify/options.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Counter of the work of all searches of one identification, with a limit. The unit is one
/// integration step of one state vector, or of the derivatives of the state with respect to one
/// quantity. Unlike a time limit, this limit gives the same result on a slow or busy machine.
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

/// The best fit so far. The fit of a further model stops early (LogFit::gave_up) if its quick
/// searches end with much larger errors than those of this fit (is_far_worse() in multistart.h).
struct BestSoFar {
  double relative_error;  ///< LogFit::relative_error, in quick searches
  bool has_large_drift;   ///< LogFit::has_large_drift()
  /// True: the other model is used only if its AIC is lower by more than kFamilyAicThreshold, and
  /// the errors of the best fit are nearly white, so that their mean square shows the gain of AIC.
  bool needs_large_gain = false;
};

struct LogFitOptions {
  Vehicle vehicle;
  /// One per ParameterId: initial guess of a free parameter, or value of a fixed parameter.
  ParameterValues<double> initial_guess{};
  /// Free parameters whose initial guess is only an order of magnitude, so that the multistart
  /// varies them. Empty if all initial guesses come from other trials; one search then suffices.
  std::vector<ParameterId> guessed;
  std::vector<ParameterId> free;
  bool frees(ParameterId id) const { return contains(free, id); }
  /// Terms of resistance families, and back-EMF, that are fixed at 0 in this fit. A score test
  /// predicts how much each of them would improve the fit.
  std::vector<ParameterId> candidate_terms;
  /// Free delays, lags, and errors of commands and sensors. A motor lag that the vehicle file gives
  /// is not listed, because it is fixed.
  std::vector<FreeTerm> terms;
  std::vector<LogChannel> biases;  ///< channels whose constant offset is estimated
  bool finds_delays = true;        ///< true: the fit also searches delays.h for further terms
  /// Coulomb friction that the search for further terms may add, because the resistance family of
  /// its axis is a power law that the user did not select.
  std::vector<ParameterId> optional_coulomb;
  /// True: the fit stops early (LogFit::has_changes_between_rows) if the commands probably change
  /// between the rows of the logs.
  bool tests_changes = false;
  double window_s = kWindow_s;  ///< longest window, s
  /// Time interval of the rows that are fitted, s. Commands before it still act through delays and
  /// lags. Absent: all rows.
  std::optional<Interval> only_s;
  /// Further initial guesses, for example the optimum of a fit with another resistance family.
  std::vector<ParameterValues<double>> also_from;
  /// Noise levels with which the search begins, from a fit at nearly the same coordinates. If
  /// empty, the search begins with the noise of the sensors.
  NoiseLevels noise;
  /// The fit stops early (LogFit::gave_up) if LogFit::relative_error exceeds this value after the
  /// first round of settle_noise().
  double give_up_above = std::numeric_limits<double>::infinity();
  /// Absent: the fit never stops after its quick searches.
  std::optional<BestSoFar> best_so_far;
  Loss loss = Loss::kSquared;  ///< use a robust loss if a sensor has outliers
  std::uint64_t seed = 1;      ///< seed of the multistart and of the bootstrap
  int multistart = 6;          ///< number of random initial guesses in addition to the given one
  int bootstrap = 0;           ///< number of resamples of the block bootstrap; 0: no bootstrap
  int threads = 0;             ///< number of threads; 0: one per core. Does not affect the result
  /// Counts the work of the searches and limits it. All fits share this counter. Absent: no limit.
  std::shared_ptr<Effort> effort;
  /// Time at which all searches stop. Absent: no time limit.
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

}  // namespace awmr
