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

}  // namespace

std::optional<Tuning> with_own_gains(const ObjectiveSetting& setting, const Tuning& common,
                                     const std::function<Result<Tuning>(YawMode)>& search) {
  double gained = 0.0;  // sum of the decrease of ln(objective) over the modes
  std::vector<Tuning> own;
  for (const YawMode mode : setting.modes()) {
    Result<Tuning> alone = search(mode);
    if (!alone || alone->gains.observer.is_on()) return std::nullopt;
    const ObjectiveSetting runs = runs_in(setting, {}, mode);
    if (settled_share(runs, alone->gains) < settled_share(runs, common.gains) - kSettlesLess) {
      return std::nullopt;
    }
    const Objective objective(runs, common.baseline.gains);
    gained += std::log(objective(common.gains).objective / objective(alone->gains).objective);
    own.push_back(*std::move(alone));
  }
  if (!(gained >= kWorthOwnGains * static_cast<double>(own.size()))) return std::nullopt;
  Tuning all = std::move(own.back());  // combined is the last mode
  own.pop_back();
  std::vector<ModeCertificate> certified;
  for (const Tuning& one : own) certified.push_back(one.certificate->modes.front());
  all.certificate->modes.insert(all.certificate->modes.begin(), certified.begin(), certified.end());
  all.own = std::move(own);
  all.alone = common.alone;
  return all;
}

}  // namespace awmr
