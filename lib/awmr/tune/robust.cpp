#include "awmr/tune/robust.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/plant_sampler.h"

namespace awmr {
namespace {

/// Median, 95 % quantile (the smallest value that 95 % of the values do not exceed) and mean of the
/// tail, the largest `tail_share` of the values.
EvaluatedFigure figure_of(const std::string& name, std::vector<double> values, double tail_share) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto tail = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(tail_share * n)));
  const double worst = std::accumulate(values.end() - eigen_index(tail), values.end(), 0.0);
  return {name, rank_quantile(values, 0.5), rank_quantile(values, 0.95),
          worst / static_cast<double>(tail)};
}

EvaluatedGains evaluate(const EvaluatedRuns& runs, YawMode mode, double tail_share) {
  EvaluatedGains result{.gains = runs.gains, .mode = mode, .figures = {}, .scenario = {}};
  std::array<std::vector<double>, kRunFigures> values;
  int completed = 0;
  for (const RunOutcome& outcome : runs.outcomes) {
    if (outcome.mode != mode) continue;
    completed += outcome.completed ? 1 : 0;
    for (std::size_t i = 0; i < kRunFigures; ++i) values[i].push_back(outcome.figures[i]);
  }
  result.completed_share = completed / static_cast<double>(values.front().size());
  const std::vector<std::string> names = run_figure_names();
  for (std::size_t i = 0; i < kRunFigures; ++i) {
    result.figures.push_back(figure_of(names[i], std::move(values[i]), tail_share));
  }
  return result;
}

/// Selects the runs in the scenario with the index `scenario`, of `count` scenarios.
EvaluatedRuns in_scenario(const EvaluatedRuns& runs, std::size_t scenario, std::size_t count) {
  EvaluatedRuns of_one{runs.gains, {}};
  for (std::size_t i = scenario; i < runs.outcomes.size(); i += count) {
    of_one.outcomes.push_back(runs.outcomes[i]);
  }
  return of_one;
}

/// Multiplies m' and I'z.
void scale_mass(double factor, DrawnVehicle& vehicle) {
  vehicle.plant.mass_norm *= factor;
  vehicle.plant.inertia_norm *= factor;
}

/// Mass factor of drawn vehicle `number` (1, 2, ...). It changes from each vehicle to the next.
double mass_factor(const UnmodelledVariation& open, std::size_t number) {
  const std::size_t masses = open.mass_factors.size();
  return masses == 0 ? 1.0 : open.mass_factors[(number - 1) % masses];
}

/// Applies the unmodelled variation (payload, battery voltage) to drawn vehicle `number` (1, 2,
/// ...). The wheel-force range changes after all mass factors were used with it.
void open_up(const UnmodelledVariation& open, std::size_t number, DrawnVehicle& vehicle) {
  const std::size_t turn = (number - 1) % open.combinations();
  const std::size_t masses = std::max<std::size_t>(1, open.mass_factors.size());
  scale_mass(mass_factor(open, number), vehicle);
  if (!open.wheel_forces.empty()) vehicle.wheel_force = open.wheel_forces[turn / masses];
}

/// Returns a sampler of the model's covariance that ignores mass_norm_by_grip, the larger m' with
/// which a coast-down needs no more grip than tyres have (paper's vehicle: three times the
/// identified m'). The gains must meet the constraints on all draws, so draws with this m' would
/// make the gains slower for every mass. Users can request such draws with `mass_factors`.
Result<PlantSampler> sampler_of(Model model) {
  model.mass_norm_by_grip.reset();
  return PlantSampler::make(model);
}

/// XORed with the seed, to evaluate the tuned gains on vehicles that the search did not use.
constexpr std::uint64_t kEvaluationSeeds = 0x6a75646765ULL;

std::vector<NamedCandidate> candidates_of(const Tuning& tuning) {
  std::vector<NamedCandidate> candidates{{kRobustGains, tuning.gains},
                                         {"baseline", tuning.baseline.gains.common()}};
  if (tuning.baseline.source != kPaperSource) candidates.push_back({"paper", kPaperGains});
  if (tuning.gains.observer.is_on()) {
    Gains<double> unobserved = tuning.gains;
    unobserved.observer = {};
    candidates.push_back({"unobserved", unobserved});
  }
  return candidates;
}

}  // namespace

std::size_t UnmodelledVariation::combinations() const {
  return std::max<std::size_t>(1, mass_factors.size()) *
         std::max<std::size_t>(1, wheel_forces.size());
}

Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, int draws, std::uint64_t seed,
                                              const UnmodelledVariation& open, Spread spread) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> own, model.plant());
  std::vector<Plant<double>> plants(at(draws), own);
  if (!model.covariance.parameters.empty()) {
    AWMR_ASSIGN_OR_RETURN(const PlantSampler sampler, sampler_of(model));
    if (spread == Spread::kEven) {
      AWMR_ASSIGN_OR_RETURN(plants, sampler.draw_evenly(seed, draws));
    } else {
      for (int i = 0; i < draws; ++i) {
        AWMR_ASSIGN_OR_RETURN(plants[at(i)], sampler.draw(seed, i + 1));
      }
    }
  }
  std::vector<DrawnVehicle> vehicles{{own, model.vehicle.wheel_force}};
  for (const Plant<double>& plant : plants) {
    vehicles.push_back({plant, model.vehicle.wheel_force});
    open_up(open, vehicles.size() - 1, vehicles.back());
  }
  return vehicles;
}

std::vector<DrawnVehicle> without(const UnmodelledVariation& open,
                                  std::vector<DrawnVehicle> vehicles) {
  for (std::size_t i = 1; i < vehicles.size(); ++i) {
    scale_mass(1.0 / mass_factor(open, i), vehicles[i]);
    if (!open.wheel_forces.empty()) vehicles[i].wheel_force = vehicles.front().wheel_force;
  }
  return vehicles;
}

void evaluate_candidates(const ObjectiveSetting& setting,
                         const std::vector<NamedCandidate>& candidates, RobustTuning& robust) {
  const std::size_t scenarios = setting.scenarios.size();
  const RunNoise noise = draw_noise(setting);
  std::vector<EvaluatedRuns> runs;
  for (const NamedCandidate& candidate : candidates) {
    const auto scores = run_all(setting, noise, std::span(&candidate.gains, 1)).front();
    const auto of_drawn = std::span(scores).subspan(setting.modes().size() * scenarios);
    runs.push_back({candidate.name, outcomes_of(of_drawn, setting.scenarios)});
  }
  robust.evaluated.clear();
  robust.evaluated_by_scenario.clear();
  robust.goals.clear();
  for (const EvaluatedRuns& of_gains : runs) {
    for (const YawMode mode : setting.modes()) {
      robust.evaluated.push_back(evaluate(of_gains, mode, setting.tail_share));
    }
    for (const GoalInMode& one : by_mode(setting.goals, setting.modes())) {
      robust.goals.push_back(evaluate_goal(one, of_gains, scenarios));
    }
  }
  for (std::size_t i = 0; scenarios > 1 && i < scenarios; ++i) {
    for (const EvaluatedRuns& of_gains : runs) {
      const EvaluatedRuns here = in_scenario(of_gains, i, scenarios);
      for (const YawMode mode : setting.modes()) {
        robust.evaluated_by_scenario.push_back(evaluate(here, mode, setting.tail_share));
        robust.evaluated_by_scenario.back().scenario = setting.scenarios[i].name;
      }
    }
  }
}

Status evaluate_on_new_vehicles(const Model& model, ObjectiveSetting setting,
                                const TuneOptions& options, Tuning& tuning) {
  if (options.evaluation_draws == 0) return {};
  setting.seed ^= kEvaluationSeeds;
  AWMR_ASSIGN_OR_RETURN(setting.vehicles, vehicles_of(model, options.evaluation_draws, setting.seed,
                                                      options.open, Spread::kRandom));
  evaluate_candidates(setting, candidates_of(tuning), *tuning.robust);
  return {};
}

}  // namespace awmr
