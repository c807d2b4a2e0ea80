#include "awmr/identify/logs/family_screen.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "awmr/core/parallel.h"

namespace awmr {

std::vector<Families> other_families(const Families& from, bool of_yaw) {
  std::vector<Families> others;
  for (const Family family : values_in(kFamilyNames)) {
    if (of_yaw && family == Family::kDeadZone) continue;  // wheels have dead zones, yaw has none
    const Families other = of_yaw ? Families{from.surge, family} : Families{family, from.yaw};
    if (other != from) others.push_back(other);
  }
  return others;
}

FamilyFit likely_families(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                          const FamilyFit& first, const OpenAxes& open) {
  constexpr double kClearlyLess = 0.98;
  constexpr int kMostChanges = 6;
  FamilyFit best = fit_roughly_from(logs, power_law, first, first.surge, first.yaw);
  std::optional<bool> changed_yaw;  // the axis that was changed last
  for (int changes = 0; changes < kMostChanges && !is_over(power_law); ++changes) {
    std::vector<Families> others;
    for (const bool of_yaw : {false, true}) {
      if (!open.has(of_yaw) || changed_yaw == of_yaw) continue;
      const std::vector<Families> more = other_families({best.surge, best.yaw}, of_yaw);
      others.insert(others.end(), more.begin(), more.end());
    }
    std::vector<FamilyFit> fits(others.size());
    parallel_for(others.size(), power_law.threads, [&](std::size_t i) {
      fits[i] = fit_roughly_from(logs, power_law, best, others[i].surge, others[i].yaw);
    });
    const auto least = std::ranges::min_element(
        fits, {}, [](const FamilyFit& other) { return other.fit.relative_error; });
    if (least == fits.end() ||
        !(least->fit.relative_error < kClearlyLess * best.fit.relative_error)) {
      break;
    }
    changed_yaw = least->yaw != best.yaw;
    best = std::move(*least);
  }
  return best;
}

FamilyFit refine(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                 const FamilyFit& rough) {
  LogFitOptions options = from_optimum(rough.options, rough);
  options.finds_delays = power_law.finds_delays;
  return fit_with(logs, std::move(options), rough.surge, rough.yaw);
}

}  // namespace awmr
