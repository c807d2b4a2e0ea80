/// The formats that a PX4 ULog defines for its messages, and where the numbers of a topic stand in
/// them. Private to this folder. [PX4, ULog file format]
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace awmr::ulog {

inline constexpr std::size_t kLongestMessage = 65535;  ///< its size is a 16-bit number

/// The types that a format is made of in the end.
enum class Basic { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kFloat, kDouble, kBool, kChar };
/// `float[3] vel` of a format.
struct Field {
  std::string type;
  std::size_t count = 1;
  bool is_array = false;
  std::string name;
};
using Formats = std::map<std::string, std::vector<Field>, std::less<>>;

/// A number in a message.
struct Leaf {
  std::string name;
  Basic type = Basic::kU8;
  std::size_t offset = 0;
};

/// A topic's message, laid out.
struct Layout {
  std::vector<Leaf> leaves = {};
  std::size_t bytes = 0;   ///< all fields
  std::size_t needed = 0;  ///< without the padding at the end, which is not logged
};

/// The number of this type at the beginning of the bytes.
double value_in(std::string_view bytes, Basic type);

/// A name from a file as a message shows it.
std::string shown(std::string_view text);

/// Adds `vehicle_odometry:uint64_t timestamp;float[3] position;`. Errors: what is no format.
tl::expected<void, std::string> add_format(std::string_view text, Formats& formats);

/// Where the numbers of a topic's messages stand. Errors: an unknown type, types within types
/// without end, more bytes than a message can have.
tl::expected<Layout, std::string> layout_of(std::string_view format, const Formats& formats);

}  // namespace awmr::ulog
