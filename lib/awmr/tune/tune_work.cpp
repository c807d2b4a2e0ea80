#include "awmr/tune/tune_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "awmr/simulate/physics.h"
#include "awmr/tune/objective.h"

namespace awmr {
namespace {

/// Largest number of RK4 steps of a search. This many steps take some hours.
constexpr double kMaxSearchSteps = 1e11;

/// Expected duration on two cores, s, above which a search is announced.
constexpr double kLongSearch_s = 10.0;
/// Time of an RK4 step on two cores, s.
constexpr double kTimeOfStep_s = 2.5e-8;
/// Numbers of evaluations from which the duration is estimated: on all drawn vehicles in the last
/// part of the search, and on new drawn vehicles after it.
constexpr double kOnAllDraws = 12.0;
constexpr double kOnNewDraws = 3.0;

/// Calls `options.notice` if the search takes long. `steps`: RK4 steps of all runs on one vehicle;
/// `modes`: number of modes.
void announce(const TuneOptions& options, double steps, int modes) {
  double runs = static_cast<double>(options.global_evaluations) + options.local_evaluations;
  if (!options.nominal) {
    runs *= 1.0 + std::min(options.draws, kSearchedDraws * 3 / modes);
    runs += kOnAllDraws * (1.0 + options.draws) + kOnNewDraws * options.evaluation_draws;
  }
  const double time_s = runs * steps * kTimeOfStep_s;
  if (!options.notice || time_s < kLongSearch_s) return;
  options.notice(fmt::format(
      "the search for gains takes about {:.0f} s on two cores: {:.2g} integration steps", time_s,
      runs * steps));
}

}  // namespace

Status check_search_work(const TuneOptions& options, const std::vector<Scenario>& scenarios,
                         const Plant<double>& plant, const Model& model) {
  const double sample_time_s = model.vehicle.sample_time_s;
  double steps = 0.0;  // RK4 steps of one evaluation
  for (const Scenario& scenario : scenarios) {
    AWMR_RETURN_IF_ERROR(check_work(plant, model.file, scenario, sample_time_s));
    steps += static_cast<double>(tuned_modes(model.vehicle, options.mode).size()) *
             steps_of_run(plant, scenario, sample_time_s);
  }
  const double on_one_vehicle = steps;
  double evaluations = static_cast<double>(options.global_evaluations) + options.local_evaluations;
  if (!options.nominal) {
    steps *= 1.0 + options.draws;
    // After the search, about three sets of gains (candidates_of()) are evaluated on new drawn
    // vehicles.
    evaluations += 3.0 * options.evaluation_draws / (1.0 + options.draws);
  }
  if (evaluations * steps <= kMaxSearchSteps) {
    const std::size_t modes = tuned_modes(model.vehicle, options.mode).size();
    announce(options, on_one_vehicle, static_cast<int>(modes));
    return {};
  }
  return input_error(
      ErrorCode::kTooLarge, "",
      fmt::format(
          "{:g} evaluations of {:.3g} RK4 steps each ({} scenarios in every mode) exceed "
          "the limit of {:g} steps; reduce global_evaluations and local_evaluations to {:.0f} "
          "together, or shorten the scenarios",
          evaluations, steps, scenarios.size(), kMaxSearchSteps,
          std::floor(kMaxSearchSteps / steps)));
}

}  // namespace awmr
