/// Comparison of the yaw-control modes and of sets of gains in the same scenarios: metrics, paired
/// differences, ranking.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/compare/preferences.h"
#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// A set of controller gains, with its name in the rows of the comparison.
struct NamedGains {
  std::string name;  ///< name of the set; empty if there is only one set
  ModeGains gains;
};

/// Result of one run: a row of comparison.csv.
struct ComparisonRow {
  std::string scenario;
  YawMode mode{};
  int sample = 0;  ///< 0: the nominal model; 1, 2, ...: drawn samples
  Metrics metrics;
  std::string gains = {};  ///< NamedGains::name
};

/// A yaw mode with a set of gains. Contenders are ranked against each other in each scenario.
struct Contender {
  YawMode mode{};
  std::string gains;  ///< NamedGains::name; empty if there is only one set

  /// "combined", or "combined with tuned.json" if there are several sets of gains.
  std::string label() const;
  friend bool operator==(const Contender&, const Contender&) = default;
};

/// Smallest number of samples with which the 95 % intervals are right. With fewer samples, they
/// contain the true value in fewer than 95 % of the cases.
inline constexpr int kFewSamples = 6;

/// Maximum number of runs of a comparison: scenarios x sets of gains x modes x samples (including
/// the nominal model). It limits the memory: a run takes about 2 kB.
inline constexpr std::size_t kMaxRuns = 1'000'000;

struct CompareOptions {
  /// Monte-Carlo samples in addition to the nominal model (sample 0), >= 0. More samples resolve
  /// smaller differences. 0: only the nominal model, without intervals or tests.
  int samples = 0;
  /// Seed of the draws, the noise and the bootstrap. Repeat with other seeds to see how much a
  /// verdict depends on chance.
  std::uint64_t seed = 1;
  /// Weights of the metrics in the ranking. They do not affect the simulated rows.
  Preferences preferences = {};
  /// Computes Comparison::break_even; needs a single set of gains.
  bool break_even = false;
  /// Computes Comparison::changes: further rankings, each with one changed assumption. One ranking
  /// uses the plant that the scenario does not use (3-DOF model or four wheels). If there is a
  /// single set of gains, two more rankings use slower and faster gains. If the comparison is
  /// divided into parts (`shard`), only part 1 computes these rankings.
  bool other_settings = false;
  /// Tyres with which `other_settings` simulates a scenario that has none.
  Tyres<double> tyres = {};
  /// Part of the samples to run; merge_shards() (shard.h) combines the parts. Default: all samples.
  /// At most as many parts as samples (including the nominal model).
  Shard shard = {};
  /// Number of threads, >= 0; 0: one per core. Results do not depend on it.
  int threads = 0;
  /// Called with the numbers of finished and of all runs, on the thread that called compare().
  std::function<void(std::size_t done, std::size_t total)> progress = {};
  /// If *stop becomes true, no further run starts, and current runs finish. Null: no stop.
  const std::atomic<bool>* stop = nullptr;
};

/// Break-even scrub of two modes on the nominal model: the scrub of the tyres (Plant::yaw_scrub_m)
/// at which `mode` is no longer ahead of `against`. Scrub acts in every mode, and the controller
/// does not compensate it.
struct BreakEven {
  std::string scenario;
  YawMode mode{};     ///< the mode with the better score without scrub
  YawMode against{};  ///< the other mode, which has smaller wheel-force differences
  /// Smallest scrub moment at which `mode` is no longer ahead, divided by F_max, m, > 0. Its error
  /// is at most 1 % of the value or 3e-8 times most_m, whichever is larger. Absent if the mode
  /// stays ahead up to most_m.
  std::optional<double> yaw_coulomb_m;
  /// Largest yaw moment that left and right wheel forces can make, divided by F_max, m: 2 d (F'max
  /// - F'min), d: half of the track width.
  double most_m = 0.0;
  /// Largest possible scrub, divided by F_max, m: 0.8 g m' l_f, the moment of four tyres that slide
  /// sideways with a friction of 0.8. The centre of gravity is assumed half-way between the axles.
  double sliding_m = 0.0;
  /// Highest yaw rate in the run of `mode` on the nominal model without scrub, deg/s, >= 0.
  double fastest_degps = 0.0;
  /// Range of the scrub moment measured in differential turns, divided by F_max, m. It contains the
  /// 95 % interval and the largest moment that did not turn the vehicle. If scrub depends on the
  /// yaw rate, it contains the values at all measured rates. If only the moment that did not turn
  /// the vehicle is known, the range extends from this moment to most_m. Absent if nothing was
  /// measured.
  std::optional<Interval> measured_m = {};
  /// Yaw rates of the turns in which scrub was measured, deg/s; absent if the model has no scrub.
  std::optional<Interval> measured_degps = {};
  /// Total number of differential turns, including those already recorded, that would decide
  /// whether `mode` stays ahead with the measured scrub. Assumes that further turns have the same
  /// mean and scatter. At most 1000. Absent if the result is already decided, or if turns cannot
  /// decide it.
  std::optional<int> turns_to_decide = {};
};

/// Whether BreakEven::mode is still ahead with the measured scrub.
enum class Lead {
  kKept,  ///< the mode is ahead with any scrub up to most_m, or in the whole measured range
  kLost,  ///< the mode is ahead nowhere in the measured range
  /// Undecided: the mode is ahead in only a part of the range. Or some scrub up to most_m ends its
  /// lead, and the run turns at yaw rates at which scrub was not measured (turns_at_other_rates()
  /// in break_even.h).
  kOpen,
};
inline constexpr NameTable<Lead, 3> kLeadNames{
    {{"kept", Lead::kKept}, {"lost", Lead::kLost}, {"open", Lead::kOpen}}};
/// Returns whether the first mode of an entry is still ahead; absent if scrub was not measured.
std::optional<Lead> lead_of(const BreakEven& entry);

/// An assumption that is changed to test whether the ranking depends on it.
enum class ChangeKind { kPlant, kWeights, kGains };
inline constexpr NameTable<ChangeKind, 3> kChangeKindNames{{{"plant", ChangeKind::kPlant},
                                                            {"weights", ChangeKind::kWeights},
                                                            {"gains", ChangeKind::kGains}}};

/// Number of completed runs of one mode (with its gains) under a changed assumption.
struct Completion {
  Contender contender;
  std::size_t count = 0;  ///< number of completed runs
  std::size_t of = 0;     ///< number of counted runs (ModeRows::counted()), > 0
};

/// The best modes of a scenario if one assumption is changed.
struct Change {
  std::string scenario;
  ChangeKind kind{};
  std::string setting;  ///< name of the change: the plant ("model"), gains ("slower") or weights
  /// modes of rank 1; for kWeights, modes that have rank 1 with all changed weights
  std::vector<Contender> first;
  std::string not_run = {};                ///< why there is no ranking; empty if there is one
  std::vector<Completion> completed = {};  ///< completed runs by contender; empty for kWeights
};

/// Result of compare().
struct Comparison {
  std::vector<ComparisonRow> rows;  ///< finished runs, sorted by scenario, gains, mode, sample
  /// Number of complete samples before the first incomplete sample, including the nominal model. A
  /// sample is complete if its runs are finished in every scenario and mode with every set of
  /// gains. Fewer than requested if the comparison was stopped, or is a part.
  int whole_samples = 0;
  bool stopped = false;  ///< true: stopped before all runs were done
  /// Rounding of the runs (BatchArithmetic::rounding): "fused" or "scalar". Rows with different
  /// rounding cannot be combined.
  std::string arithmetic = {};
  /// Highest yaw rate at which yaw resistance was measured, deg/s, > 0; absent if unknown.
  std::optional<double> measured_yaw_rate_degps = {};
  /// Heading commands of each scenario, by its name. The finding `beyond-trials` needs them.
  std::map<std::string, TurnCommands> turn_commands = {};
  /// Break-even scrub of each scenario and pair of modes; absent if not requested, or if stopped.
  std::optional<std::vector<BreakEven>> break_even = {};
  /// Result of changes_of_runs() (decision.h); empty if not requested.
  std::vector<Change> changes = {};
};

/// Simulates every scenario with every mode and set of gains, on the nominal model and on samples.
/// A scenario without sensors or actuators gets those of the vehicle (equipped() in
/// simulate/conditions.h).
/// For a sample, the fitted parameters are drawn from the model's covariance
/// (simulate/plant_sampler.h). Noise and disturbances are drawn with the seeds of scenario and
/// options. All modes and gains use the same draws. The controller uses the nominal parameters.
/// compare() finishes a block of kBatchRuns samples (simulate/batch.h) in every scenario and mode
/// before the next block starts. So a stopped comparison is valid for the samples that it finished.
///
/// Errors (input): the model lacks a parameter, a covariance (with samples) or an interval that a
/// scenario's corner needs; no scenario or gains, or two of the same name; a negative number of
/// samples or threads; a part that does not exist; more than kMaxRuns runs; break-even with several
/// sets of gains, in a part, or for a scenario on four wheels; the errors of check_scenario(),
/// controller_for() and break_even_of(). Also the error of a run that fails.
Result<Comparison> compare(const Model& model, const std::vector<NamedGains>& gains,
                           const std::vector<Scenario>& scenarios, const CompareOptions& options);
Result<Comparison> compare(const Model& model, const ModeGains& gains,
                           const std::vector<Scenario>& scenarios, const CompareOptions& options);

/// The metrics of a run with their names, in the order of comparison.csv.
std::vector<std::pair<std::string_view, std::optional<double>>> named_metrics(
    const Metrics& metrics);

/// Content of comparison.csv. `completed` is 1 or 0; a metric that does not apply has an empty
/// cell. If there are several sets of gains, the last column is `gains`, the name of the set.
std::string comparison_csv(const Comparison& comparison);
/// Content of comparison.json: options, statistics, ranking and verdict of each scenario.
std::string comparison_text(const Comparison& comparison, const CompareOptions& options,
                            const Provenance& provenance);

/// Text for a terminal: metrics by scenario and mode, the ranking, and a verdict in one sentence.
std::string comparison_table(const Comparison& comparison, const CompareOptions& options = {});

/// The JSON Schema of comparison.json.
std::string comparison_schema();

}  // namespace awmr
