#include "awmr/tune/global_sensitivity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/core/random.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/sobol.h"

namespace awmr {
namespace {

constexpr const char* kFigures[] = {"settling_time_s", "overshoot_deg", "heading_iae_degs"};

/// One sample: a value of every input.
struct Sample {
  Model model;                                               ///< only its parameters are used
  double noise_level = 1.0, latency = 1.0, motor_lag = 1.0;  ///< factors on the assumed values
  std::size_t noise = 0;                                     ///< number of the noise realisation
};

/// An input, with the function that copies its value from one sample to another.
struct Input {
  std::string name;
  std::function<void(const Sample& from, Sample& to)> take;
};

/// Groups of parameters with non-zero covariances. Parameters of different groups are uncorrelated.
std::vector<std::vector<ParameterId>> tied_sets(const Covariance& covariance) {
  const std::size_t n = covariance.parameters.size();
  std::vector<std::size_t> set_of(n);
  std::iota(set_of.begin(), set_of.end(), 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (covariance.matrix[i][j] == 0.0) continue;
      std::replace(set_of.begin(), set_of.end(), set_of[i], set_of[j]);
    }
  }
  std::vector<std::vector<ParameterId>> sets;
  for (std::size_t set = 0; set < n; ++set) {
    std::vector<ParameterId> members;
    for (std::size_t i = 0; i < n; ++i) {
      if (set_of[i] == set) members.push_back(covariance.parameters[i]);
    }
    if (!members.empty()) sets.push_back(std::move(members));
  }
  return sets;
}

std::vector<Input> inputs_of(const Model& model) {
  std::vector<Input> inputs;
  for (std::vector<ParameterId>& set : tied_sets(model.covariance)) {
    std::vector<std::string_view> names;
    for (const ParameterId id : set) names.push_back(info(id).name);
    inputs.push_back({fmt::format("{}", fmt::join(names, ", ")),
                      [set = std::move(set)](const Sample& from, Sample& to) {
                        for (const ParameterId id : set) to.model[id].value = from.model[id].value;
                      }});
  }
  inputs.push_back({"level of the sensors' noise",
                    [](const Sample& from, Sample& to) { to.noise_level = from.noise_level; }});
  inputs.push_back({"latency of the sensors",
                    [](const Sample& from, Sample& to) { to.latency = from.latency; }});
  inputs.push_back(
      {"lag of the motors", [](const Sample& from, Sample& to) { to.motor_lag = from.motor_lag; }});
  inputs.push_back(
      {"noise realisation", [](const Sample& from, Sample& to) { to.noise = from.noise; }});
  return inputs;
}

/// Draws `count` samples. Their noise realisations have the numbers first + 1, first + 2, ...
Result<std::vector<Sample>> drawn_samples(const Model& model, std::uint64_t seed, std::size_t first,
                                          int count) {
  std::optional<PlantSampler> sampler;
  if (!model.covariance.parameters.empty()) {
    AWMR_ASSIGN_OR_RETURN(sampler, PlantSampler::make(model));
  }
  std::vector<Sample> samples;
  for (int i = 1; i <= count; ++i) {
    Sample sample{.model = model, .noise = first + at(i)};
    const int number = static_cast<int>(first) + i;
    if (sampler) {
      AWMR_ASSIGN_OR_RETURN(sample.model, sampler->draw_model(seed, number));
    }
    sample.model.record = {};  // not needed; saves memory, because each sample has a model
    Random random(seed ^ 0x736f626f6cULL, static_cast<std::uint64_t>(number));
    for (double* level : {&sample.noise_level, &sample.latency, &sample.motor_lag}) {
      *level = 2.0 * random.uniform();
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

LoopConditions conditions_at(const Sample& sample, LoopConditions c) {
  for (double* noise : {&c.heading_noise_deg, &c.yaw_rate_noise_degps, &c.speed_noise_mps}) {
    *noise *= sample.noise_level;
  }
  for (double* latency_s : {&c.heading_latency_s, &c.yaw_rate_latency_s, &c.speed_latency_s}) {
    *latency_s *= sample.latency;
  }
  c.motor_time_constant_s *= sample.motor_lag;
  return c;
}

/// Metrics of one sample as means over the scenarios, by mode, then metric. Empty if a run breaks
/// off.
std::vector<double> figures_at(const Sample& sample, const ObjectiveSetting& setting,
                               const LoopConditions& assumed,
                               const Controller<double>& controller) {
  const std::span<const YawMode> modes = setting.modes();
  // plant_as_known() does not check for missing parameters, but a drawn model has every parameter
  // of the model.
  const Plant<double> plant = sample.model.plant_as_known();
  std::vector<BatchRun> runs;
  for (const YawMode mode : modes) {
    runs.push_back({plant, controller, mode, setting.seed, sample.noise});
  }
  std::vector<double> figures(modes.size() * std::size(kFigures), 0.0);
  for (const Scenario& base : setting.scenarios) {
    const Scenario scenario = under(conditions_at(sample, assumed), base);
    const auto metrics =
        simulate_batch(runs, scenario, setting.vehicle.sample_time_s, setting.arithmetic);
    for (std::size_t mode = 0; mode < modes.size(); ++mode) {
      if (!metrics[mode]) return {};
      const ModeScore score{
          .scenario = scenario.name, .mode = modes[mode], .metrics = *metrics[mode]};
      for (std::size_t f = 0; f < std::size(kFigures); ++f) {
        figures[mode * std::size(kFigures) + f] +=
            figure_of_run(kFigures[f], outcome_of(score, scenario)) /
            static_cast<double>(setting.scenarios.size());
      }
    }
  }
  return figures;
}

}  // namespace

double sensitivity_runs(const Model& model, int samples) {
  return samples * (2.0 + static_cast<double>(inputs_of(model).size()));
}

Result<GlobalSensitivity> global_sensitivity(const Model& model, const ObjectiveSetting& setting,
                                             const LoopConditions& assumed,
                                             const Gains<double>& gains, int samples) {
  const std::vector<Input> inputs = inputs_of(model);
  AWMR_ASSIGN_OR_RETURN(const std::vector<Sample> a,
                        drawn_samples(model, setting.seed, 0, samples));
  AWMR_ASSIGN_OR_RETURN(const std::vector<Sample> b,
                        drawn_samples(model, setting.seed, at(samples), samples));
  const auto controller = make_controller(setting.vehicles.front().plant, setting.vehicle, gains);
  const std::size_t n = at(samples);
  // The metrics of each sample, in this order: the samples AB_i of each input i, then A, then B
  // (sobol.h).
  std::vector<std::vector<double>> figures((inputs.size() + 2) * n);
  parallel_for(figures.size(), 0, [&](std::size_t i) {
    const std::size_t input = i / n;
    Sample sample = input == inputs.size() + 1 ? b[i % n] : a[i % n];
    if (input < inputs.size()) inputs[input].take(b[i % n], sample);
    figures[i] = figures_at(sample, setting, assumed, controller);
  });
  const auto broken_off = std::ranges::count_if(
      figures, [](const std::vector<double>& of_sample) { return of_sample.empty(); });
  if (broken_off > 0) {
    return refusal(
        ErrorCode::kDiverges,
        fmt::format(
            "runs of the tuned loop diverge for {} of {} samples of parameters, noise, latency and "
            "motor lag, so the sensitivity is unknown; tune without sensitivity",
            broken_off, figures.size()));
  }
  const std::span<const YawMode> modes = setting.modes();
  GlobalSensitivity result{.samples = samples, .inputs = {}, .figures = {}};
  for (const Input& input : inputs) result.inputs.push_back(input.name);
  for (std::size_t f = 0; f < modes.size() * std::size(kFigures); ++f) {
    const auto values_of = [&](std::size_t input) {
      std::vector<double> values;
      for (std::size_t j = 0; j < n; ++j) values.push_back(figures[input * n + j][f]);
      return values;
    };
    std::vector<std::vector<double>> mixed;
    for (std::size_t input = 0; input < inputs.size(); ++input) mixed.push_back(values_of(input));
    std::vector<double> own = values_of(inputs.size());
    std::vector<double> other = values_of(inputs.size() + 1);
    SensitiveFigure figure{.mode = modes[f / std::size(kFigures)],
                           .name = kFigures[f % std::size(kFigures)],
                           .mean = 0.0,
                           .deviation = 0.0,
                           .by_input = sobol_indices(own, other, mixed, setting.seed)};
    own.insert(own.end(), other.begin(), other.end());
    figure.mean = std::accumulate(own.begin(), own.end(), 0.0) / static_cast<double>(own.size());
    double squares = 0.0;
    for (const double value : own) squares += (value - figure.mean) * (value - figure.mean);
    figure.deviation = std::sqrt(squares / static_cast<double>(own.size() - 1));
    result.figures.push_back(std::move(figure));
  }
  return result;
}

}  // namespace awmr
