// Evaluates the paper's claims for all combinations of settings that the paper does not give.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <utility>

#include "awmr/core/gravity.h"
#include "awmr/core/parallel.h"
#include "awmr/core/tyre_friction.h"
#include "awmr/validate/claims.h"

namespace awmr {
namespace {

/// Factor on the normalised mass m' with which a tyre friction of 0.8 is just enough for full
/// thrust (open_cases()).
double mass_factor(const Model& model) {
  const double least_mass_norm = kFullThrust / (kTyreFriction * kGravity_mps2);
  return least_mass_norm / *model[ParameterId::kMassNorm].value;
}

Model model_in(const ClaimCase& open, Model model) {
  model.vehicle.wheel_force = open.wheel_force;
  for (const ParameterId id : {ParameterId::kMassNorm, ParameterId::kInertiaNorm}) {
    *model[id].value *= open.mass_factor;
  }
  return model;
}

ControlOptions control_in(const ClaimCase& open) {
  ControlOptions control;
  control.split = open.split;
  control.allocation = open.allocation;
  return control;
}

/// Divides the indices of the cases into batches with the same allocation and split. A batch has at
/// most two cases, to limit the memory: with two cases, the six runs of claim C11 take 120 MB.
std::vector<std::vector<std::size_t>> batches_of(const std::vector<ClaimCase>& cases) {
  constexpr std::size_t kCasesMax = 2;
  std::map<std::pair<AllocationForm, CombinedSplit>, std::vector<std::size_t>> open;
  std::vector<std::vector<std::size_t>> batches;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::vector<std::size_t>& batch = open[{cases[i].allocation, cases[i].split}];
    batch.push_back(i);
    if (batch.size() == kCasesMax) batches.push_back(std::exchange(batch, {}));
  }
  for (auto& [control, batch] : open) {
    if (!batch.empty()) batches.push_back(std::move(batch));
  }
  return batches;
}

ClaimCase with_result(ClaimCase open, bool reproduced) {
  open.reproduced = reproduced;
  return open;
}

/// The settings that the paper leaves open.
constexpr std::array kSettings{"allocation", "wheel_force", "mass_factor", "split"};
/// Values of these settings in a case, in the same order.
using Key = std::array<std::pair<double, double>, kSettings.size()>;

Key key_of(const ClaimCase& open) {
  return {{{static_cast<double>(open.allocation), 0.0},
           {open.wheel_force.lo, open.wheel_force.hi},
           {open.mass_factor, 0.0},
           {static_cast<double>(open.split), 0.0}}};
}

/// Returns two numbers: in how many combinations of all settings except `setting` (an index in
/// kSettings) the verdict depends on this setting, and how many such combinations there are.
std::pair<int, int> places_decided(const std::vector<ClaimCase>& cases, std::size_t setting) {
  // For each combination of the other settings, two flags: whether a case reproduces the claim, and
  // whether a case does not.
  std::map<Key, std::pair<bool, bool>> places;
  for (const ClaimCase& open : cases) {
    Key others = key_of(open);
    others[setting] = {};
    auto& [holds, fails] = places[others];
    (open.reproduced ? holds : fails) = true;
  }
  const auto decided = std::count_if(places.begin(), places.end(), [](const auto& place) {
    return place.second.first && place.second.second;
  });
  return {static_cast<int>(decided), static_cast<int>(places.size())};
}

}  // namespace

std::vector<ClaimCase> open_cases(const Model& model) {
  std::vector<double> factors{1.0};
  if (const double factor = mass_factor(model); factor > 1.0) factors.push_back(factor);
  std::vector<ClaimCase> cases;
  for (const AllocationForm allocation : {AllocationForm::kExact, AllocationForm::kPaper}) {
    for (const Interval force : {Interval{-1.0, 1.0}, Interval{0.0, 1.0}, Interval{0.0, 0.5}}) {
      for (const double factor : factors) {
        for (const CombinedSplit split :
             {CombinedSplit::kRedistribute, CombinedSplit::kFixedHalf}) {
          cases.push_back({allocation, force, factor, split, false});
        }
      }
    }
  }
  return cases;
}

void add_open_cases(const Model& model, const std::optional<ModeGains>& gains,
                    const BatchArithmetic& arithmetic, std::vector<Claim>& claims,
                    const Progress& progress) {
  const std::vector<ClaimCase> cases = open_cases(model);
  const std::vector<std::vector<std::size_t>> batches = batches_of(cases);
  std::vector<std::vector<Claim>> claims_by_case(cases.size());
  std::atomic<std::size_t> done = 0;
  LoopControl control;
  if (progress) control.progress = [&] { progress(done, cases.size()); };
  const auto evaluate = [&](std::size_t b) {
    std::vector<Model> models;
    for (const std::size_t i : batches[b]) models.push_back(model_in(cases[i], model));
    auto claims_of =
        check_claims_of(models, gains, arithmetic, control_in(cases[batches[b].front()]));
    for (std::size_t i = 0; i < claims_of.size(); ++i) {
      claims_by_case[batches[b][i]] = std::move(claims_of[i]);
    }
    done += claims_of.size();
  };
  parallel_for(batches.size(), 0, evaluate, control);
  for (std::size_t c = 0; c < claims.size(); ++c) {
    Claim& claim = claims[c];
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const Claim& there = claims_by_case[i][c];
      claim.cases.push_back(with_result(cases[i], there.reproduced));
      for (std::size_t m = 0; m < claim.modes.size(); ++m) {
        claim.modes[m].cases.push_back(with_result(cases[i], there.modes[m].reproduced));
      }
    }
    claim.decided_by = decisive_settings(claim.cases);
  }
}

std::string decisive_settings(const std::vector<ClaimCase>& cases) {
  std::vector<std::pair<double, std::string>> decisive;
  for (std::size_t setting = 0; setting < kSettings.size(); ++setting) {
    const auto [decided, places] = places_decided(cases, setting);
    if (decided == 0) continue;
    decisive.emplace_back(static_cast<double>(decided) / places,
                          fmt::format("{} ({} of {})", kSettings[setting], decided, places));
  }
  std::stable_sort(decisive.begin(), decisive.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [share, words] : decisive) text += (text.empty() ? "" : ", ") + words;
  return text;
}

}  // namespace awmr
