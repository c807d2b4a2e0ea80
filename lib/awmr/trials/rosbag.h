/// ROS 2 bags in SQLite (`.db3`). Private to this folder.
///
/// Signals are named `TOPIC.FIELD`, the topic without its first '/': `odom.twist.twist.linear.x`.
/// The time is the bag's receive time: one clock for all topics.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_rosbag(std::string_view bytes);

/// Returns the header of the bag and the values of the requested signals. Topics of unsupported
/// types are noted. Errors: not a bag; a message that does not match its type or is not in CDR.
Result<Signals> read_rosbag(std::string_view bytes, const std::string& file, const Wanted& wanted);

}  // namespace awmr
