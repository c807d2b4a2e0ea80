/// Plants drawn from what the trials leave uncertain. Private to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Draws the parameters of the model's covariance C, the others stay at their values. A quantity
/// that has to be positive is drawn in its logarithm, where by the delta method
///   Cov(ln p, ln q) = C_pq/(p q),   Cov(ln p, q) = C_pq/p,
/// so that its median is the model's value; exponents b are drawn as they are and drawn again,
/// all parameters together, until they lie in the vehicle's surge_beta_range and yaw_beta_range.
class PlantSampler {
 public:
  /// Errors (input): a parameter has no value; no covariance; one that is no covariance.
  static Result<PlantSampler> make(const Model& model);

  /// The plant of `sample` (>= 1): depends on seed and sample alone. Errors (input): the ranges of
  /// the exponents leave next to nothing to draw.
  Result<Plant<double>> draw(std::uint64_t seed, int sample) const;
  /// The same as a model, whose intervals are still those of the identified one.
  Result<Model> draw_model(std::uint64_t seed, int sample) const;

 private:
  Model model_;
  std::vector<double> centre_;               ///< ln p or b, by position in the covariance
  std::vector<std::vector<double>> factor_;  ///< L with L L^T = the covariance of those
};

}  // namespace awmr
