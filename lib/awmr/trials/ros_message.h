/// The numbers in a message of ROS 2, for the usual types. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace awmr {

/// The names of the numbers in a message of this type (`nav_msgs/msg/Odometry`), in their order;
/// nothing for a type that is not read.
std::optional<std::vector<std::string>> ros_fields(std::string_view type);

/// The values, in the order of ros_fields(), from a message in CDR (plain, either byte order).
/// Nothing where the bytes end too early or are not of that form. Precondition: the type is read.
std::optional<std::vector<double>> ros_values(std::string_view type, std::string_view cdr);

}  // namespace awmr
