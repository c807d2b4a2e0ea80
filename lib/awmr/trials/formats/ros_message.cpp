#include "ros_message.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "byte_reader.h"

namespace awmr {
namespace {

/// Kinds of elements of a message. kSkipped9, kSkipped36: covariances (arrays of 9 and 36 doubles),
/// which are not read.
enum class Part { kHeader, kText, kFloat32, kFloat64, kSkipped9, kSkipped36 };

struct Piece {
  Part part;
  std::string_view name = {};  ///< name of the signal if the part is a number
  /// If not empty, the part has one number per letter, with the signals NAME.x, NAME.y, ...
  std::string_view axes = {};
};

struct MessageType {
  std::string_view name;
  std::vector<Piece> pieces;
};

constexpr Part kD = Part::kFloat64;

/// Supported types, as in the public message definitions. Covariances are skipped.
const std::array<MessageType, 7>& types() {
  static const std::array<MessageType, 7> kTypes{
      {{"std_msgs/msg/Float32", {{Part::kFloat32, "data"}}},
       {"std_msgs/msg/Float64", {{kD, "data"}}},
       {"geometry_msgs/msg/Twist", {{kD, "linear", "xyz"}, {kD, "angular", "xyz"}}},
       {"geometry_msgs/msg/TwistStamped",
        {{Part::kHeader}, {kD, "twist.linear", "xyz"}, {kD, "twist.angular", "xyz"}}},
       {"ackermann_msgs/msg/AckermannDriveStamped",
        {{Part::kHeader},
         {Part::kFloat32, "drive.steering_angle"},
         {Part::kFloat32, "drive.steering_angle_velocity"},
         {Part::kFloat32, "drive.speed"},
         {Part::kFloat32, "drive.acceleration"},
         {Part::kFloat32, "drive.jerk"}}},
       {"sensor_msgs/msg/Imu",
        {{Part::kHeader},
         {kD, "orientation", "xyzw"},
         {Part::kSkipped9},
         {kD, "angular_velocity", "xyz"},
         {Part::kSkipped9},
         {kD, "linear_acceleration", "xyz"},
         {Part::kSkipped9}}},
       {"nav_msgs/msg/Odometry",
        {{Part::kHeader},
         {Part::kText},
         {kD, "pose.pose.position", "xyz"},
         {kD, "pose.pose.orientation", "xyzw"},
         {Part::kSkipped36},
         {kD, "twist.twist.linear", "xyz"},
         {kD, "twist.twist.angular", "xyz"},
         {Part::kSkipped36}}}}};
  return kTypes;
}

/// Reads a message in CDR (the serialisation of ROS 2). Numbers are aligned to their size. Offsets
/// count from the end of the encoding header, which has 4 bytes.
class CdrReader {
 public:
  /// Precondition: at least four bytes.
  explicit CdrReader(std::string_view cdr) : big_(cdr[1] == 0), body_(cdr.substr(4)) {}

  template <class T>
  std::optional<T> number() {
    const std::size_t padding = (sizeof(T) - body_.offset() % sizeof(T)) % sizeof(T);
    if (!body_.take(padding)) return std::nullopt;
    return body_.number<T>(big_);
  }
  bool skip_text() {
    const auto length = number<std::uint32_t>();
    return length && body_.take(*length).has_value();
  }
  bool skip_doubles(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!number<double>()) return false;
    }
    return true;
  }
  /// Skips seconds, nanoseconds and frame.
  bool skip_header() { return number<std::int32_t>() && number<std::uint32_t>() && skip_text(); }

 private:
  bool big_;
  ByteReader body_;
};

/// Reads one element and appends its numbers to `values`; false at the end of the bytes.
bool take(const Piece& piece, CdrReader& reader, std::vector<double>& values) {
  switch (piece.part) {
    case Part::kHeader:
      return reader.skip_header();
    case Part::kText:
      return reader.skip_text();
    case Part::kSkipped9:
      return reader.skip_doubles(9);
    case Part::kSkipped36:
      return reader.skip_doubles(36);
    case Part::kFloat32: {
      const auto value = reader.number<float>();
      values.push_back(static_cast<double>(value.value_or(0.0F)));
      return value.has_value();
    }
    case Part::kFloat64:
      for (std::size_t i = 0; i < std::max<std::size_t>(piece.axes.size(), 1); ++i) {
        const auto value = reader.number<double>();
        if (!value) return false;
        values.push_back(*value);
      }
      return true;
  }
  return false;
}

}  // namespace

std::optional<std::vector<std::string>> ros_fields(std::string_view type) {
  const auto found = std::ranges::find(types(), type, &MessageType::name);
  if (found == types().end()) return std::nullopt;
  std::vector<std::string> names;
  for (const Piece& piece : found->pieces) {
    const std::string name(piece.name);
    for (const char axis : piece.axes) names.push_back(name + "." + axis);
    if (piece.axes.empty() && !name.empty()) names.push_back(name);
  }
  return names;
}

std::optional<std::vector<double>> ros_values(std::string_view type, std::string_view cdr) {
  const bool is_plain_cdr = cdr.size() >= 4 && cdr[0] == 0 && (cdr[1] == 0 || cdr[1] == 1);
  if (!is_plain_cdr) return std::nullopt;
  CdrReader reader(cdr);
  std::vector<double> values;
  for (const Piece& piece : std::ranges::find(types(), type, &MessageType::name)->pieces) {
    if (!take(piece, reader, values)) return std::nullopt;
  }
  return values;
}

}  // namespace awmr
