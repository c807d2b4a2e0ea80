#include "awmr/tune/own_gains.h"

#include <cmath>
#include <utility>
#include <vector>

#include "awmr/tune/settling.h"

namespace awmr {
namespace {

/// Smallest decrease of ln(objective), as the mean over the modes, with which own gains are used.
const double kWorthOwnGains = -std::log(0.95);
/// Largest decrease of the share of settled runs in a mode.
constexpr double kSettlesLess = 0.05;

/// Removes the elements of other modes.
template <class Results>
void keep_only(YawMode mode, Results& results) {
  std::erase_if(results, [mode](const auto& one) { return one.mode != mode; });
}

/// Returns the results of a tuning for all modes in one of them.
Tuning in_mode(Tuning tuning, YawMode mode) {
  tuning.mode = mode;
  keep_only(mode, tuning.scores);
  keep_only(mode, tuning.baseline_scores);
  keep_only(mode, tuning.held_out_scores);
  keep_only(mode, tuning.certificate->modes);
  keep_only(mode, tuning.unsettled);
  if (!tuning.robust) return tuning;
  keep_only(mode, tuning.robust->evaluated);
  keep_only(mode, tuning.robust->evaluated_by_scenario);
  keep_only(mode, tuning.robust->goals);
  return tuning;
}

/// Decrease of ln(objective) with own gains in place of the common ones in the runs of one mode.
/// Empty if the mode keeps the common gains.
std::optional<double> gain(const ObjectiveSetting& runs, const Tuning& common, const Tuning& own) {
  const Objective objective(runs, common.baseline.gains);
  const double gained =
      std::log(objective(common.gains).objective / objective(own.gains).objective);
  if (!std::isfinite(gained) || gained <= 0.0) return std::nullopt;
  if (settled_share(runs, own.gains) < settled_share(runs, common.gains) - kSettlesLess) {
    return std::nullopt;
  }
  return gained;
}

}  // namespace

std::optional<Tuning> with_own_gains(const ObjectiveSetting& setting, const Tuning& common,
                                     const std::function<Result<Tuning>(YawMode)>& search) {
  double gained = 0.0;  // sum over the modes
  std::vector<Tuning> all;
  std::vector<ModeCertificate> certified;
  for (const YawMode mode : setting.modes()) {
    Result<Tuning> own = search(mode);
    const auto of_mode = own ? gain(runs_in(setting, {}, mode), common, *own) : std::nullopt;
    gained += of_mode.value_or(0.0);
    all.push_back(of_mode ? *std::move(own) : in_mode(common, mode));
    certified.push_back(all.back().certificate->modes.front());
  }
  if (!(gained >= kWorthOwnGains * static_cast<double>(all.size()))) return std::nullopt;
  Tuning tuning = std::move(all.back());  // combined is the last mode
  all.pop_back();
  tuning.certificate->modes = std::move(certified);
  tuning.own = std::move(all);
  return tuning;
}

}  // namespace awmr
