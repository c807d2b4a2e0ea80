#include "dataflash_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr::dataflash {
namespace {

template <class T>
constexpr FieldKind number_kind(char character, double scale = 1.0) {
  return {character, sizeof(T), scale, read_number<T>};
}

/// A text, an array or a 16-bit float.
constexpr FieldKind skipped(char character, std::size_t bytes) {
  return {character, bytes, 0.0, nullptr};
}

/// Kinds c, C, e and E are hundredths; L is 1e-7 degrees.
constexpr std::array<FieldKind, 21> kKinds{number_kind<std::int8_t>('b'),
                                           number_kind<std::uint8_t>('B'),
                                           number_kind<std::uint8_t>('M'),
                                           number_kind<std::int16_t>('h'),
                                           number_kind<std::uint16_t>('H'),
                                           number_kind<std::int32_t>('i'),
                                           number_kind<std::uint32_t>('I'),
                                           number_kind<std::int64_t>('q'),
                                           number_kind<std::uint64_t>('Q'),
                                           number_kind<float>('f'),
                                           number_kind<double>('d'),
                                           number_kind<std::int16_t>('c', 0.01),
                                           number_kind<std::uint16_t>('C', 0.01),
                                           number_kind<std::int32_t>('e', 0.01),
                                           number_kind<std::uint32_t>('E', 0.01),
                                           number_kind<std::int32_t>('L', 1e-7),
                                           skipped('a', 64),
                                           skipped('n', 4),
                                           skipped('N', 16),
                                           skipped('Z', 64),
                                           skipped('g', 2)};

}  // namespace

std::string text_of(std::string_view bytes) {
  return std::string(bytes.substr(0, bytes.find('\0')));
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

tl::expected<Format, std::string> format_of(std::string_view bytes) {
  Format format{.definition = std::string(bytes),
                .name = text_of(bytes.substr(2, 4)),
                .bytes = static_cast<unsigned char>(bytes[1])};
  const std::string characters = text_of(bytes.substr(6, 16));
  const std::string labels = text_of(bytes.substr(22, 64));
  const auto names = labels.empty() ? std::vector<std::string_view>() : split_at_commas(labels);
  const std::string shown = printable(format.name);
  if (names.size() != characters.size()) {
    return tl::unexpected(
        fmt::format("{} has {} fields and {} names", shown, characters.size(), names.size()));
  }
  std::size_t end = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto* kind = std::ranges::find(kKinds, characters[i], &FieldKind::character);
    if (kind == kKinds.end()) {
      return tl::unexpected(fmt::format("{} has a field of the unknown kind '{}'", shown,
                                        printable(characters.substr(i, 1))));
    }
    if (names[i] == "TimeUS" || (names[i] == "TimeMS" && !format.time)) format.time = i;
    format.fields.push_back({std::string(names[i]), kind, end});
    end += kind->bytes;
  }
  if (format.bytes != end + kRecordHeaderBytes) {
    return tl::unexpected(fmt::format("{} declares {} bytes, but header and fields have {}", shown,
                                      format.bytes, end + kRecordHeaderBytes));
  }
  return format;
}

std::optional<std::int64_t> nanoseconds(const Format& format, std::uint64_t ticks) {
  const std::int64_t tick_ns = format.fields[*format.time].name == "TimeUS" ? 1'000 : 1'000'000;
  if (static_cast<double>(ticks) * static_cast<double>(tick_ns) > 9e18) return std::nullopt;
  return static_cast<std::int64_t>(ticks) * tick_ns;
}

ListedTopic list_topic(const Format& format, std::uint8_t sensor, const Wanted& wanted,
                       Signals& signals) {
  ListedTopic listed{.topic = signals.topics.size()};
  const std::string topic =
      format.name + (sensor == 0 ? std::string() : fmt::format("[{}]", sensor));
  signals.topics.push_back({.name = topic});
  for (std::size_t i = 0; i < format.fields.size(); ++i) {
    const Field& field = format.fields[i];
    if (i == *format.time || i == format.instance || field.kind->read == nullptr) continue;
    if (add_signal(topic + "." + field.name, wanted, signals)) listed.fields.push_back(i);
  }
  return listed;
}

Status check_count(const Signals& signals, const std::string& file) {
  if (signals.header.size() <= kMaxSignals) return {};
  return input_error(ErrorCode::kTooLarge, file,
                     fmt::format("there are more than {} signals, the most that awmr reads; "
                                 "export fewer signals",
                                 kMaxSignals));
}

}  // namespace awmr::dataflash
