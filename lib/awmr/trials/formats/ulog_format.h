/// Parses the message formats of a PX4 ULog, and finds the offsets of the numbers in a message.
/// Private to trials/. [PX4, ULog file format]
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace awmr::ulog {

inline constexpr std::size_t kLongestMessage = 65535;  ///< bytes; the file format has a 16-bit size

/// Basic type of a field.
struct Basic {
  std::string_view name;  ///< "uint64_t"
  std::size_t bytes;
  double (*read)(std::string_view bytes);  ///< returns the number at the beginning of the bytes
};
/// A field such as `float[3] vel`.
struct Field {
  std::string type;
  std::size_t count = 1;
  bool is_array = false;
  std::string name;
};
using Formats = std::map<std::string, std::vector<Field>, std::less<>>;

/// A number in a message, possibly within nested types.
struct Leaf {
  std::string name;  ///< name of the signal without its topic: "position[2]", "pose.x"
  const Basic* type = nullptr;
  std::size_t offset = 0;
};

/// Layout of a topic's message.
struct Layout {
  std::vector<Leaf> leaves = {};
  std::size_t bytes = 0;   ///< size of all fields, bytes
  std::size_t needed = 0;  ///< bytes without the padding at the end, which is not logged
};

/// Sanitises a name from a file for a message.
std::string shown(std::string_view text);

/// Parses a format such as `vehicle_odometry:uint64_t timestamp;float[3] position;` and adds it to
/// `formats`. Errors: an invalid format.
tl::expected<void, std::string> add_format(std::string_view text, Formats& formats);

/// Returns the layout of messages of this format. Errors: an unknown type; types nested more than
/// eight deep; more bytes than a message can have.
tl::expected<Layout, std::string> layout_of(std::string_view format, const Formats& formats);

}  // namespace awmr::ulog
