/// Inputs of a comparison: their checks, and the plants that it simulates (the nominal plant and
/// the drawn samples). Private to compare/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// Checks the input of compare(), before anything is simulated. Errors: those of compare() about
/// the options, the number of runs, and the names and numbers of scenarios and gains; the errors of
/// controller_for().
Status check_comparison(const Model& model, const std::vector<NamedGains>& gains,
                        const std::vector<Scenario>& scenarios, const CompareOptions& options);

struct SampledPlants {
  Plant<double> nominal{};              ///< the model's own values, which the controller uses
  std::vector<Plant<double>> vehicles;  ///< plants by scenario, then sample 0, 1, ...
  std::size_t samples = 0;              ///< number of samples, including sample 0

  const Plant<double>& vehicle(std::size_t scenario, std::size_t sample) const {
    return vehicles[scenario * samples + sample];
  }
};

/// Makes the plants of all samples. Sample 0 is the model itself; samples 1 ... options.samples are
/// drawn from the model's covariance (simulate/plant_sampler.h). A scenario with a corner
/// (parameters moved to the ends of their intervals) applies the corner to every sample. Errors
/// (input): the model lacks a parameter, a covariance (with samples), or an interval that a corner
/// needs; the errors of check_scenario().
Result<SampledPlants> sample_plants(const Model& model, const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options);

}  // namespace awmr
