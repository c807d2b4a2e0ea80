/// Numbers in ROS 2 messages of the usual types. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace awmr {

/// Names of the numbers in a message of this type (`nav_msgs/msg/Odometry`), in order; empty for an
/// unsupported type.
std::optional<std::vector<std::string>> ros_fields(std::string_view type);

/// Values of a CDR message (plain, either byte order), in the order of ros_fields(). Empty if the
/// message is too short or not of that form. Precondition: the type is supported.
std::optional<std::vector<double>> ros_values(std::string_view type, std::string_view cdr);

}  // namespace awmr
