#include "awmr/identify/logs/choice/back_emf.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Total time, s, with the motors off in which the vehicle probably still rolls: the first kRolls_s
/// seconds after driving. Gaps between rows of the log do not count.
double coasting_s(const DrivingLog& log) {
  constexpr double kRolls_s = 3.0;
  const double gap_s = kGapSteps * log.median_step_s();
  double coasts_s = 0.0;
  double off_since_s = -std::numeric_limits<double>::infinity();
  bool was_driven = false;
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    const double step_s = log.t_s[row + 1] - log.t_s[row];
    const bool off = !(log.force_left[row] != 0.0 || log.force_right[row] != 0.0);
    if (was_driven && off) off_since_s = log.t_s[row];
    if (off && log.t_s[row] - off_since_s < kRolls_s && step_s <= gap_s) coasts_s += step_s;
    was_driven = !off;
  }
  return coasts_s;
}

}  // namespace

std::string why_no_back_emf(const std::vector<DrivingLog>& logs) {
  constexpr double kEnough_s = 1.0;
  double coasts_s = 0.0;
  for (const DrivingLog& log : logs) coasts_s += coasting_s(log);
  if (coasts_s >= kEnough_s) return {};
  return fmt::format(
      "the vehicle coasts (both forces 0) within 3 s of driving for only {:.2g} s in total, but "
      "1 s is needed: while the motors drive, back-EMF is indistinguishable from linear resistance",
      coasts_s);
}

LogFitOptions with_back_emf(LogFitOptions options) {
  // Initial guess of k_e: at 1 m/s, the back-EMF drag of all driven wheels is this fraction of the
  // surge resistance.
  constexpr double kShare = 0.1;
  double& guess = options.initial_guess[at(ParameterId::kBackEmf)];
  if (!(guess > 0.0)) {
    guess = kShare * options.initial_guess[at(ParameterId::kSurgeAlpha)] /
            options.vehicle.driven_wheels();
  }
  if (!options.frees(ParameterId::kBackEmf)) options.free.push_back(ParameterId::kBackEmf);
  std::erase(options.candidate_terms, ParameterId::kBackEmf);
  return options;
}

LogFitOptions with_back_emf_as_in(const FamilyFit& fit, LogFitOptions options) {
  if (!fit.options.frees(ParameterId::kBackEmf)) return options;
  return with_back_emf(std::move(options));
}

bool suspects_back_emf(const LogFit& fit, const std::vector<ParameterId>& candidate_terms) {
  constexpr double kWorthATry = 4.0;
  const auto candidate_term = std::ranges::find(candidate_terms, ParameterId::kBackEmf);
  if (candidate_term == candidate_terms.end()) return false;
  if (!fit.usable || fit.candidate_gain[at(candidate_term - candidate_terms.begin())] > kWorthATry)
    return true;
  return std::ranges::any_of(fit.noise,
                             [](const auto& channel) { return channel.second.has_slow_drift(); });
}

bool shows_back_emf(const FamilyFit& with, const FamilyFit& without) {
  if (!with.fit.usable) return false;
  if (with.fit.has_large_drift()) return false;
  // A fit with an insignificant back-EMF can only have found a better optimum of the model without.
  const auto k = place_of(with.fit.quantities, ParameterId::kBackEmf);
  if (!k || !with.fit.refusal_reason[*k].empty() || !with.fit.is_significant(*k)) return false;
  return aic_lead(with.fit, without.fit) > kFamilyAicThreshold;
}

Finding back_emf_finding(const std::string& file, const FamilyFit& with, const FamilyFit& without) {
  const auto i = place_of(with.fit.quantities, ParameterId::kBackEmf);
  const EstimatorParameter k = i ? with.fit.report.parameters[*i] : EstimatorParameter{};
  return {file, 0, Severity::kWarning, "back-emf",
          fmt::format("the motor force decreases with the speed (back-EMF), by {:.3g} +- {:.2g} of "
                      "the largest force per m/s. The model with back-EMF is used, because {}; the "
                      "coasting sections then determine the resistance",
                      k.value, k.std_error.value_or(0.0),
                      without.fit.usable
                          ? fmt::format("its AIC is lower by {}",
                                        aic_decrease_text(aic_lead(with.fit, without.fit)))
                          : "the model without it does not converge")};
}

}  // namespace awmr
