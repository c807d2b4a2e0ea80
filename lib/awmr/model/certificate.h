/// Smallest damping ratio and delay margin of the closed heading loop over a set of plants, as
/// stored in gains.json.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace awmr {

/// Values of `/certificate/set` in gains.json: the plants among which the worst case was searched.
/// kCertifiedSet: the 95 % confidence region of the parameters, for a model with a covariance.
/// kUncertifiedSet: only the identified plant.
inline constexpr const char* kCertifiedSet = "95 %";
inline constexpr const char* kUncertifiedSet = "the model's own values";

/// Worst case of one mode of yaw control.
struct CertifiedMode {
  std::string mode;          ///< "differential", "steering" or "combined"
  double damping_min = 0.0;  ///< smallest damping ratio over the set; <= 0: unstable
  /// Smallest delay, s, in addition to CertifiedGains::latency_s, at which the loop becomes
  /// unstable; infinity: it stays stable.
  double delay_margin_s = 0.0;
};

/// The worst cases in `/certificate` of gains.json. The file also has the parameters at which they
/// occur; these are not read.
struct CertifiedGains {
  std::string set;         ///< kCertifiedSet or kUncertifiedSet
  double latency_s = 0.0;  ///< s: delay of the loop that all worst cases include
  std::vector<CertifiedMode> modes;
};

}  // namespace awmr
