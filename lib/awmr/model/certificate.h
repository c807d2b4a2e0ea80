/// Worst-case damping and delay margin of the closed heading loop, as in gains.json.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace awmr {

/// Values of `/certificate/set` with and without a covariance of the model.
inline constexpr const char* kCertifiedSet = "95 %";
inline constexpr const char* kUncertifiedSet = "the model's own values";

struct CertifiedMode {
  std::string mode;
  double damping_min = 0.0;     ///< smallest damping ratio over the set; <= 0: unstable
  double delay_margin_s = 0.0;  ///< smallest additional delay that makes the loop unstable;
                                ///< infinity: none
};

/// `/certificate` of gains.json, without the parameters of the worst cases.
struct CertifiedGains {
  std::string set;  ///< kCertifiedSet or kUncertifiedSet
  double latency_s = 0.0;
  std::vector<CertifiedMode> modes;
};

}  // namespace awmr
