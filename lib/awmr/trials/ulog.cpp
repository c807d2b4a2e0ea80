#include "ulog.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "awmr/core/name_table.h"
#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr {
namespace {

constexpr std::string_view kMagic("\x55\x4C\x6F\x67\x01\x12\x35", 7);
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kLongestMessage = 65535;  ///< its size is a 16-bit number
constexpr int kDeepest = 8;                     ///< nested types within types

enum class Basic { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kFloat, kDouble, kBool, kChar };
constexpr NameTable<Basic, 12> kBasicNames{{{"int8_t", Basic::kI8},
                                            {"uint8_t", Basic::kU8},
                                            {"int16_t", Basic::kI16},
                                            {"uint16_t", Basic::kU16},
                                            {"int32_t", Basic::kI32},
                                            {"uint32_t", Basic::kU32},
                                            {"int64_t", Basic::kI64},
                                            {"uint64_t", Basic::kU64},
                                            {"float", Basic::kFloat},
                                            {"double", Basic::kDouble},
                                            {"bool", Basic::kBool},
                                            {"char", Basic::kChar}}};

std::size_t size_of(Basic type) {
  switch (type) {
    case Basic::kI16:
    case Basic::kU16:
      return 2;
    case Basic::kI32:
    case Basic::kU32:
    case Basic::kFloat:
      return 4;
    case Basic::kI64:
    case Basic::kU64:
    case Basic::kDouble:
      return 8;
    default:
      return 1;
  }
}

double value_in(std::string_view bytes, Basic type) {
  switch (type) {
    case Basic::kI8:
      return number_in<std::int8_t>(bytes);
    case Basic::kI16:
      return number_in<std::int16_t>(bytes);
    case Basic::kU16:
      return number_in<std::uint16_t>(bytes);
    case Basic::kI32:
      return number_in<std::int32_t>(bytes);
    case Basic::kU32:
      return number_in<std::uint32_t>(bytes);
    case Basic::kI64:
      return static_cast<double>(number_in<std::int64_t>(bytes));
    case Basic::kU64:
      return static_cast<double>(number_in<std::uint64_t>(bytes));
    case Basic::kFloat:
      return static_cast<double>(number_in<float>(bytes));
    case Basic::kDouble:
      return number_in<double>(bytes);
    default:
      return number_in<std::uint8_t>(bytes);
  }
}

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

std::string shown(std::string_view text) { return printable(shortened(text, 60)); }

std::optional<Field> field_of(std::string_view text) {
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos || space == 0 || space + 1 == text.size())
    return std::nullopt;
  Field field{.type = std::string(text.substr(0, space)),
              .name = std::string(text.substr(space + 1))};
  const std::size_t open = field.type.find('[');
  if (open == std::string::npos) return field;
  const char* end = field.type.data() + field.type.size();
  const auto [stop, error] = std::from_chars(field.type.data() + open + 1, end, field.count);
  if (error != std::errc() || stop + 1 != end || *stop != ']') return std::nullopt;
  if (field.count == 0 || field.count > kLongestMessage) return std::nullopt;
  field.is_array = true;
  field.type.resize(open);
  return field;
}

/// `vehicle_odometry:uint64_t timestamp;float[3] position;`
tl::expected<void, std::string> add_format(std::string_view text, Formats& formats) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) {
    return tl::unexpected(fmt::format("\"{}\" is no format", shown(text)));
  }
  std::vector<Field> fields;
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(one.size() + 1, rest.size()));
    if (one.empty()) continue;
    auto field = field_of(one);
    if (!field) return tl::unexpected(fmt::format("\"{}\" is no field of a format", shown(one)));
    fields.push_back(*std::move(field));
  }
  if (fields.empty()) return tl::unexpected(fmt::format("\"{}\" has no fields", shown(text)));
  formats.insert_or_assign(std::string(text.substr(0, colon)), std::move(fields));
  return {};
}

/// Adds the numbers of a format, `prefix` before their names; bounded by the size of a message.
tl::expected<void, std::string> lay_out(std::string_view format, const std::string& prefix,
                                        int depth, const Formats& formats, Layout& layout) {
  const auto found = formats.find(format);
  if (found == formats.end() || depth > kDeepest) {
    return tl::unexpected(fmt::format("\"{}\" is {}", shown(format),
                                      depth > kDeepest ? "an endless format" : "no known type"));
  }
  for (const Field& field : found->second) {
    const auto basic = value_in(kBasicNames, std::string_view(field.type));
    const bool is_padding = field.name.starts_with("_padding");
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string name =
          prefix + field.name + (field.is_array ? fmt::format("[{}]", i) : std::string());
      if (!basic) {
        const auto inner = lay_out(field.type, name + ".", depth + 1, formats, layout);
        if (!inner) return inner;
      } else {
        const bool is_number = *basic != Basic::kChar && !is_padding;
        if (is_number) layout.leaves.push_back({name, *basic, layout.bytes});
        layout.bytes += size_of(*basic);
        if (!is_padding) layout.needed = layout.bytes;
      }
      if (layout.bytes > kLongestMessage) {
        return tl::unexpected(
            fmt::format("the format \"{}\" is longer than any message", shown(format)));
      }
    }
  }
  return {};
}

/// A topic whose messages are in the file.
struct Subscription {
  std::size_t needed = 0;
  std::optional<std::size_t> time_offset = {};  ///< of `timestamp`; none: no time series
  std::vector<Leaf> wanted = {};
  std::size_t topic = 0;  ///< in Signals::topics
};

/// What is read so far.
struct Reading {
  const std::string& file;
  const Wanted& wanted;
  Formats formats = {};
  std::map<std::uint16_t, Subscription> subscriptions = {};
  Signals signals = {};
};

tl::unexpected<Error> wrong(const Reading& reading, std::size_t offset, std::string_view what) {
  return input_error(reading.file, fmt::format("byte {}: {}", offset, what));
}

/// 'A': instance, id, name.
Status subscribe(ByteReader message, std::size_t offset, Reading& reading) {
  const auto instance = message.number<std::uint8_t>();
  const auto id = message.number<std::uint16_t>();
  const auto name = message.take(message.left());
  if (!instance || !id || name->empty())
    return wrong(reading, offset, "a subscription is too short");
  const std::string topic =
      std::string(*name) + (*instance == 0 ? std::string() : fmt::format("[{}]", *instance));
  Layout layout;
  if (const auto laid = lay_out(*name, "", 0, reading.formats, layout); !laid) {
    return wrong(reading, offset, laid.error());
  }
  Subscription subscription{.needed = layout.needed, .topic = reading.signals.topics.size()};
  Topic& added = reading.signals.topics.emplace_back(Topic{.name = topic});
  for (Leaf& leaf : layout.leaves) {
    if (leaf.name == "timestamp" && leaf.type == Basic::kU64)
      subscription.time_offset = leaf.offset;
  }
  if (subscription.time_offset) {
    for (Leaf& leaf : layout.leaves) {
      const std::string& signal = reading.signals.header.emplace_back(topic + "." + leaf.name);
      if (!reading.wanted(signal)) continue;
      added.columns.push_back(reading.signals.header.size() - 1);
      added.values.emplace_back();
      subscription.wanted.push_back(std::move(leaf));
    }
  }
  if (reading.signals.header.size() > kMostSignals) {
    return wrong(reading, offset, fmt::format("there are more than {} signals", kMostSignals));
  }
  if (!reading.subscriptions.emplace(*id, std::move(subscription)).second) {
    return wrong(reading, offset, fmt::format("a second topic has the id {}", *id));
  }
  return {};
}

/// 'D': id, fields.
Status take_data(std::string_view message, std::size_t offset, Reading& reading) {
  ByteReader reader(message);
  const auto id = reader.number<std::uint16_t>();
  const auto found = id ? reading.subscriptions.find(*id) : reading.subscriptions.end();
  if (found == reading.subscriptions.end()) {
    return wrong(reading, offset, "a message is of a topic that was not announced");
  }
  const Subscription& subscription = found->second;
  if (subscription.wanted.empty()) return {};
  const std::string_view fields = message.substr(reader.offset());
  Topic& topic = reading.signals.topics[subscription.topic];
  if (fields.size() < subscription.needed) {
    return wrong(reading, offset,
                 fmt::format("a message of {} has {} bytes, its format {}", shown(topic.name),
                             fields.size(), subscription.needed));
  }
  const auto time_us = number_in<std::uint64_t>(fields.substr(*subscription.time_offset));
  if (time_us > static_cast<std::uint64_t>(INT64_MAX / 1000)) {
    return wrong(reading, offset, fmt::format("the time {} us cannot be", time_us));
  }
  topic.time_ns.push_back(static_cast<std::int64_t>(time_us) * 1000);
  for (std::size_t i = 0; i < subscription.wanted.size(); ++i) {
    const Leaf& leaf = subscription.wanted[i];
    topic.values[i].push_back(value_in(fields.substr(leaf.offset), leaf.type));
  }
  return {};
}

/// 'B': flags that a reader must know, and where data were appended after a crash.
Result<std::vector<std::uint64_t>> flags_of(std::string_view message, std::size_t offset,
                                            const Reading& reading) {
  constexpr std::size_t kFlagBytes = 40;
  if (message.size() < kFlagBytes) return wrong(reading, offset, "the flags are too short");
  std::string_view incompatible = message.substr(8, 8);
  const bool known = (static_cast<unsigned char>(incompatible[0]) & 0xFEU) == 0 &&
                     incompatible.substr(1) == std::string(7, '\0');
  if (!known)
    return wrong(reading, offset, "the file is of a newer kind of ULog than is known here");
  std::vector<std::uint64_t> appended;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = number_in<std::uint64_t>(message.substr(16 + 8 * i));
    if (at != 0) appended.push_back(at);
  }
  return appended;
}

}  // namespace

bool is_ulog(std::string_view bytes) { return bytes.starts_with(kMagic); }

Result<Signals> read_ulog(std::string_view bytes, const std::string& file, const Wanted& wanted) {
  Reading reading{.file = file, .wanted = wanted};
  ByteReader reader(bytes);
  reader.seek(kHeaderBytes);
  std::vector<std::uint64_t> appended;
  while (reader.left() > 0) {
    const std::size_t offset = reader.offset();
    const auto size = reader.number<std::uint16_t>();
    const auto type = reader.number<char>();
    const auto message = size && type ? reader.take(*size) : std::nullopt;
    // What was appended after a crash begins where the message before it was cut.
    const auto cut = std::find_if(appended.begin(), appended.end(), [&](std::uint64_t at) {
      return at > offset && at < (message ? reader.offset() : bytes.size());
    });
    if (!message || cut != appended.end()) {
      reading.signals.notes.push_back(
          {0, "log-truncated",
           fmt::format(
               "the file breaks off inside a message at byte {}; what stands before is read",
               offset)});
      reader.seek(cut != appended.end() ? *cut : bytes.size());
      continue;
    }
    if (*type == 'B') {
      AWMR_ASSIGN_OR_RETURN(appended, flags_of(*message, offset, reading));
    } else if (*type == 'F') {
      if (const auto added = add_format(*message, reading.formats); !added) {
        return wrong(reading, offset, added.error());
      }
    } else if (*type == 'A') {
      AWMR_RETURN_IF_ERROR(subscribe(ByteReader(*message), offset, reading));
    } else if (*type == 'D') {
      AWMR_RETURN_IF_ERROR(take_data(*message, offset, reading));
    }
  }
  return std::move(reading.signals);
}

}  // namespace awmr
