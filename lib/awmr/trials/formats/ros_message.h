/// Decodes the numbers in ROS 2 messages of the supported types, which FORMATS.md lists. Private to
/// trials/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace awmr {

/// Names of the numbers in a message of this type (such as `nav_msgs/msg/Odometry`), in the order
/// of the message. Empty for an unsupported type.
std::optional<std::vector<std::string>> ros_fields(std::string_view type);

/// Values in a message, in the order of ros_fields(). `cdr`: the message in plain CDR (the
/// serialisation of ROS 2), of either byte order. Empty if the message is too short or is not plain
/// CDR. Precondition: the type is supported.
std::optional<std::vector<double>> ros_values(std::string_view type, std::string_view cdr);

}  // namespace awmr
