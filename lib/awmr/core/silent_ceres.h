/// For the folders that search with Ceres. Private: not installed.
#pragma once

#include <glog/logging.h>

namespace awmr {

/// Stops Ceres from logging to stderr why a search ended: the result contains the reason.
inline void silence_ceres() {
  static const int level = FLAGS_minloglevel =
      google::GLOG_FATAL;  // once, whichever thread is first
  static_cast<void>(level);
}

}  // namespace awmr
