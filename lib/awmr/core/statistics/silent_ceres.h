/// Disables the log output of Ceres. Private: not installed.
#pragma once

#include <glog/logging.h>

namespace awmr {

/// Stops Ceres from logging to stderr why a search ended. The result of the search also has this
/// reason.
inline void silence_ceres() {
  static const int level = FLAGS_minloglevel =
      google::GLOG_FATAL;  // once, in the first thread that gets here
  static_cast<void>(level);
}

}  // namespace awmr
