#include "awmr/identify/logs/term_trials.h"

#include <algorithm>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/information.h"

namespace awmr {

double akaike_of(const NoiseIteration& fit) {
  return akaike(fit.problem.model.noise, rows_of(fit.problem.model.quantities));
}

NoiseIteration tried(const NoiseIteration& settled, const std::vector<FreeTerm>& more, Loss loss) {
  constexpr double kLargestFirstStep = 3.0;  // in large changes
  std::vector<FreeQuantity> quantities;
  std::vector<double> begin;
  for (const FreeTerm& term : more) {
    quantities.push_back(term.quantity);
    const double most = kLargestFirstStep * term.quantity.large_change;
    begin.push_back(term.quantity.is_form() ? term.begin : std::clamp(term.begin, -most, most));
  }
  Extended from = extended(with_white_noise(settled.problem), settled.point, quantities, begin);
  if (has_force_excess(quantities)) {
    from.problem.model.longest_step_s = step_s_at(from.problem.model, from.point.coordinates);
  }
  return settle_noise(std::move(from.problem), std::move(from.point), loss, {.most = 1});
}

std::optional<NoiseIteration> settled_if_better(const NoiseIteration& settled, Extended from,
                                                Loss loss) {
  constexpr double kPlainly = 10.0;
  NoiseIteration fit = settle_noise(std::move(from.problem), std::move(from.point), loss);
  if (!(akaike_of(settled) - akaike_of(fit) > kPlainly)) return std::nullopt;
  return fit;
}

}  // namespace awmr
