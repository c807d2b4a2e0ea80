/// For the folders that search with Ceres. Private: not installed.
#pragma once

#include <glog/logging.h>

namespace awmr {

/// Ceres says on stderr why it stopped, through its logging library; here that is in the result.
inline void silence_ceres() {
  static const int level = FLAGS_minloglevel =
      google::GLOG_FATAL;  // once, whichever thread is first
  static_cast<void>(level);
}

}  // namespace awmr
