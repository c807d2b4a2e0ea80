#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "byte_reader.h"
#include "log_formats.h"
#include "ulog_format.h"

namespace awmr {
namespace {

constexpr std::string_view kMagic("\x55\x4C\x6F\x67\x01\x12\x35", 7);
constexpr std::size_t kFileHeaderBytes = 16;

struct Subscription {
  std::size_t needed = 0;  ///< minimum size of a message, bytes
  /// Offset of the field `timestamp`; empty: not a time series.
  std::optional<std::size_t> time_offset = {};
  std::vector<ulog::Leaf> wanted = {};  ///< requested numbers of the topic
  std::size_t topic = 0;                ///< index in Signals::topics
};

struct Reading {
  const std::string& file;
  const Wanted& wanted;
  ulog::Formats formats = {};
  std::map<std::uint16_t, Subscription> subscriptions = {};
  Signals signals = {};
};

tl::unexpected<Error> wrong(const Reading& reading, std::size_t offset, std::string_view what) {
  return input_error(ErrorCode::kBrokenFile, reading.file,
                     fmt::format("byte {}: {}", offset, what));
}

/// Reads a message of type 'A', which announces a topic: instance number, id, name.
Status subscribe(ByteReader message, std::size_t offset, Reading& reading) {
  const auto instance = message.number<std::uint8_t>();
  const auto id = message.number<std::uint16_t>();
  const auto name = message.take(message.left());
  if (!instance || !id || name->empty())
    return wrong(reading, offset, "the message that announces a topic is too short");
  const std::string topic =
      std::string(*name) + (*instance == 0 ? std::string() : fmt::format("[{}]", *instance));
  auto layout = ulog::layout_of(*name, reading.formats);
  if (!layout) return wrong(reading, offset, layout.error());
  Subscription subscription{.needed = layout->needed, .topic = reading.signals.topics.size()};
  reading.signals.topics.push_back({.name = topic});
  for (ulog::Leaf& leaf : layout->leaves) {
    if (leaf.name == "timestamp" && leaf.type->name == "uint64_t")
      subscription.time_offset = leaf.offset;
  }
  if (subscription.time_offset) {
    for (ulog::Leaf& leaf : layout->leaves) {
      if (!add_signal(topic + "." + leaf.name, reading.wanted, reading.signals)) continue;
      subscription.wanted.push_back(std::move(leaf));
    }
  }
  if (reading.signals.header.size() > kMaxSignals) {
    return wrong(reading, offset,
                 fmt::format("there are more than {} signals, the most that awmr reads; export "
                             "fewer signals",
                             kMaxSignals));
  }
  if (!reading.subscriptions.emplace(*id, std::move(subscription)).second) {
    return wrong(reading, offset, fmt::format("a second topic has the id {}", *id));
  }
  return {};
}

/// Reads a message of type 'D', the data of a topic: its id, then its fields.
Status take_data(std::string_view message, std::size_t offset, Reading& reading) {
  ByteReader reader(message);
  const auto id = reader.number<std::uint16_t>();
  const auto found = id ? reading.subscriptions.find(*id) : reading.subscriptions.end();
  if (found == reading.subscriptions.end()) {
    return wrong(reading, offset, "a message belongs to a topic that was not announced");
  }
  const Subscription& subscription = found->second;
  if (subscription.wanted.empty()) return {};
  const std::string_view fields = message.substr(reader.offset());
  Topic& topic = reading.signals.topics[subscription.topic];
  if (fields.size() < subscription.needed) {
    return wrong(reading, offset,
                 fmt::format("a message of {} has {} bytes; its format has {}",
                             ulog::shown(topic.name), fields.size(), subscription.needed));
  }
  const auto time_us = number_in<std::uint64_t>(fields.substr(*subscription.time_offset));
  if (time_us > static_cast<std::uint64_t>(INT64_MAX / 1000)) {
    return wrong(reading, offset, fmt::format("the time {} us is too large", time_us));
  }
  topic.time_ns.push_back(static_cast<std::int64_t>(time_us) * 1000);
  for (std::size_t i = 0; i < subscription.wanted.size(); ++i) {
    const ulog::Leaf& leaf = subscription.wanted[i];
    topic.values[i].push_back(leaf.type->read(fields.substr(leaf.offset)));
  }
  return {};
}

/// Reads a message of type 'B': flags for features that a reader must support, and the offsets of
/// data that were appended after a crash. Returns the offsets.
Result<std::vector<std::uint64_t>> flags_of(std::string_view message, std::size_t offset,
                                            const Reading& reading) {
  constexpr std::size_t kFlagBytes = 40;
  if (message.size() < kFlagBytes) return wrong(reading, offset, "the flags are too short");
  std::string_view incompatible = message.substr(8, 8);
  const bool known = (static_cast<unsigned char>(incompatible[0]) & 0xFEU) == 0 &&
                     incompatible.substr(1) == std::string(7, '\0');
  if (!known) return wrong(reading, offset, "unsupported feature of ULog; export the log as CSV");
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
  reader.seek(kFileHeaderBytes);
  std::vector<std::uint64_t> appended;
  while (reader.left() > 0) {
    const std::size_t offset = reader.offset();
    const auto size = reader.number<std::uint16_t>();
    const auto type = reader.number<char>();
    const auto message = size && type ? reader.take(*size) : std::nullopt;
    // Data appended after a crash begin where the previous message was cut.
    const auto cut = std::find_if(appended.begin(), appended.end(), [&](std::uint64_t at) {
      return at > offset && at < (message ? reader.offset() : bytes.size());
    });
    if (!message || cut != appended.end()) {
      reading.signals.notes.push_back(
          {0, "log-truncated",
           fmt::format("the file ends inside a message at byte {}; the messages before it are read",
                       offset)});
      reader.seek(cut != appended.end() ? *cut : bytes.size());
      continue;
    }
    if (*type == 'B') {
      AWMR_ASSIGN_OR_RETURN(appended, flags_of(*message, offset, reading));
    } else if (*type == 'F') {
      if (const auto added = ulog::add_format(*message, reading.formats); !added) {
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
