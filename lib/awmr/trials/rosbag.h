/// Bags of ROS 2 in SQLite (`.db3`). Private to this folder.
///
/// Signals are called `TOPIC.FIELD`, the topic without its first '/': `odom.twist.twist.linear.x`. The
/// time is the bag's, when a message was received: one clock for all topics.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_rosbag(std::string_view bytes);

/// The header of the bag, and the values of what is wanted. Topics of types that are not read are
/// noted. Errors: no bag; a message that is not of its type or not in CDR.
Result<Signals> read_rosbag(std::string_view bytes, const std::string& file, const Wanted& wanted);

}  // namespace awmr
