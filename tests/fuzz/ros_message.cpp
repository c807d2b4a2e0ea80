/// Fuzz target: reads the bytes as CDR-encoded ROS messages. The reader returns as many numbers as
/// the message type has, or an error.
#include "awmr/trials/formats/ros_message.h"

#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = awmr::fuzz::text_of(data, size);
  for (const char* type :
       {"std_msgs/msg/Float32", "std_msgs/msg/Float64", "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/TwistStamped", "ackermann_msgs/msg/AckermannDriveStamped",
        "sensor_msgs/msg/Imu", "nav_msgs/msg/Odometry"}) {
    const auto values = awmr::ros_values(type, bytes);
    if (values) require(values->size() == awmr::ros_fields(type)->size(), "one value per field");
  }
  return 0;
}
