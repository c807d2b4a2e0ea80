/// Worst-case damping and delay margin of the closed heading loop, as stored in gains.json.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace awmr {

/// Values of `/certificate/set`: the set of plants for which the worst case was computed. With a
/// covariance of the model, it is the 95 % set; without, the model alone.
inline constexpr const char* kCertifiedSet = "95 %";
inline constexpr const char* kUncertifiedSet = "the model's own values";

/// Worst case of one mode of yaw control.
struct CertifiedMode {
  std::string mode;             ///< "differential", "steering" or "combined"
  double damping_min = 0.0;     ///< smallest damping ratio over the set; <= 0: unstable
  double delay_margin_s = 0.0;  ///< smallest additional delay that makes the loop unstable;
                                ///< infinity: none
};

/// `/certificate` of gains.json, without the parameters at which the worst cases occur.
struct CertifiedGains {
  std::string set;         ///< kCertifiedSet or kUncertifiedSet
  double latency_s = 0.0;  ///< latency of the loop in the worst cases
  std::vector<CertifiedMode> modes;
};

}  // namespace awmr
