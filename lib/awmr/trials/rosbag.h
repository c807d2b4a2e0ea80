/// Reads ROS 2 bags in SQLite (`.db3`). Private to this folder.
///
/// Signals are named `TOPIC.FIELD`, the topic without its first '/': `odom.twist.twist.linear.x`.
/// The time of a message is the time at which the recorder received it, because all topics share
/// the recorder's clock.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_rosbag(std::string_view bytes);

/// Returns the names of all signals, and the values of the requested ones. Topics of unsupported
/// types, or not serialised in CDR (the format of ROS 2), are skipped and noted. Errors: not a bag;
/// more than 10000 topics; a message whose bytes do not match its type.
Result<Signals> read_rosbag(std::string_view bytes, const std::string& file, const Wanted& wanted);

}  // namespace awmr
