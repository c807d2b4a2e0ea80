/// Worst-case damping and delay margin of the closed heading loop, as gains.json has them.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace awmr {

/// `/certificate/set` where the model has a covariance, and where it has none.
inline constexpr const char* kCertifiedSet = "95 %";
inline constexpr const char* kUncertifiedSet = "the model's own values";

struct CertifiedMode {
  std::string mode;
  double damping_min = 0.0;     ///< smallest damping ratio over the set; <= 0: not stable
  double delay_margin_s = 0.0;  ///< least further delay that the loop does not bear; infinity: none
};

/// `/certificate` of gains.json, without where each worst case is.
struct CertifiedGains {
  std::string set;  ///< kCertifiedSet or kUncertifiedSet
  double latency_s = 0.0;
  std::vector<CertifiedMode> modes;
};

}  // namespace awmr
