#include "dataflash.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr {
namespace {

constexpr std::string_view kSync("\xA3\x95", 2);
constexpr std::size_t kHeaderBytes = 3;  ///< the two above and the type
constexpr std::uint8_t kFormatType = 128;
constexpr std::size_t kFormatBytes = 89;

/// A character of a record's format.
struct FieldKind {
  char character;
  std::size_t bytes;
  double scale;  ///< 0: a text
};
constexpr std::array<FieldKind, 21> kKinds{
    {{'a', 64, 0.0}, {'b', 1, 1.0},  {'B', 1, 1.0},  {'h', 2, 1.0},  {'H', 2, 1.0},  {'i', 4, 1.0},
     {'I', 4, 1.0},  {'f', 4, 1.0},  {'d', 8, 1.0},  {'n', 4, 0.0},  {'N', 16, 0.0}, {'Z', 64, 0.0},
     {'c', 2, 0.01}, {'C', 2, 0.01}, {'e', 4, 0.01}, {'E', 4, 0.01}, {'L', 4, 1e-7}, {'M', 1, 1.0},
     {'q', 8, 1.0},  {'Q', 8, 1.0},  {'g', 2, 0.0}}};

const FieldKind* kind_of(char character) {
  for (const FieldKind& kind : kKinds) {
    if (kind.character == character) return &kind;
  }
  return nullptr;
}

double value_in(std::string_view bytes, const FieldKind& kind) {
  switch (kind.character) {
    case 'b':
      return number_in<std::int8_t>(bytes);
    case 'h':
    case 'c':
      return kind.scale * number_in<std::int16_t>(bytes);
    case 'H':
    case 'C':
      return kind.scale * number_in<std::uint16_t>(bytes);
    case 'i':
    case 'e':
    case 'L':
      return kind.scale * number_in<std::int32_t>(bytes);
    case 'I':
    case 'E':
      return kind.scale * number_in<std::uint32_t>(bytes);
    case 'f':
      return static_cast<double>(number_in<float>(bytes));
    case 'd':
      return number_in<double>(bytes);
    case 'q':
      return static_cast<double>(number_in<std::int64_t>(bytes));
    case 'Q':
      return static_cast<double>(number_in<std::uint64_t>(bytes));
    default:
      return number_in<std::uint8_t>(bytes);
  }
}

struct Field {
  std::string name;
  const FieldKind* kind = nullptr;
  std::size_t offset = 0;  ///< in the record, behind its header
};

/// A type of record.
struct Format {
  std::string definition;  ///< the bytes that define it, without its own header
  std::string name;
  std::size_t bytes = 0;  ///< of a record, with its header
  std::vector<Field> fields = {};
  std::optional<std::size_t> time = {};      ///< in `fields`: TimeUS or TimeMS
  std::optional<std::size_t> instance = {};  ///< in `fields`: which of several alike
};

/// The text of a fixed number of bytes, up to its first NUL.
std::string text_of(std::string_view bytes) {
  return std::string(bytes.substr(0, bytes.find('\0')));
}

std::vector<std::string> names_of(const std::string& labels) {
  std::vector<std::string> names(labels.empty() ? 0 : 1);
  for (const char c : labels) {
    if (c == ',') {
      names.emplace_back();
    } else {
      names.back() += c;
    }
  }
  return names;
}

/// A format from the 86 bytes behind the header of an FMT record: type, length, name[4], format[16],
/// labels[64].
tl::expected<Format, std::string> format_of(std::string_view bytes) {
  Format format{.definition = std::string(bytes),
                .name = text_of(bytes.substr(2, 4)),
                .bytes = static_cast<unsigned char>(bytes[1])};
  const std::string characters = text_of(bytes.substr(6, 16));
  const std::vector<std::string> names = names_of(text_of(bytes.substr(22, 64)));
  const std::string shown = printable(format.name);
  if (names.size() != characters.size()) {
    return tl::unexpected(
        fmt::format("{} has {} fields and {} names", shown, characters.size(), names.size()));
  }
  std::size_t end = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const FieldKind* kind = kind_of(characters[i]);
    if (kind == nullptr) {
      return tl::unexpected(fmt::format("{} has a field of the unknown kind '{}'", shown,
                                        printable(characters.substr(i, 1))));
    }
    if (names[i] == "TimeUS" || (names[i] == "TimeMS" && !format.time)) format.time = i;
    format.fields.push_back({names[i], kind, end});
    end += kind->bytes;
  }
  if (format.bytes != end + kHeaderBytes) {
    return tl::unexpected(fmt::format("{} has {} bytes by its length and {} by its fields", shown,
                                      format.bytes, end + kHeaderBytes));
  }
  return format;
}

using Formats = std::map<std::uint8_t, Format>;

/// FMTU: TimeUS, type, units, multipliers; the unit '#' marks the number of an instance.
void mark_instance(std::string_view record, const Format& fmtu, Formats& formats) {
  std::optional<std::uint8_t> type;
  std::string units;
  for (const Field& field : fmtu.fields) {
    const std::string_view bytes = record.substr(field.offset, field.kind->bytes);
    if (field.name == "FmtType") type = static_cast<std::uint8_t>(bytes[0]);
    if (field.name == "UnitIds") units = text_of(bytes);
  }
  const auto found = type ? formats.find(*type) : formats.end();
  const std::size_t mark = units.find('#');
  if (found == formats.end() || mark >= found->second.fields.size()) return;
  if (found->second.fields[mark].kind->bytes == 1) found->second.instance = mark;
}

/// Calls `take(type, record, offset)` for every record that a known format describes; how many bytes
/// were passed over. `take` may add formats.
template <class Take>
Result<std::size_t> for_each_record(std::string_view bytes, const Formats& formats,
                                    const Take& take) {
  std::size_t skipped = 0;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const bool synchronised = bytes.substr(at, 2) == kSync && bytes.size() - at >= kHeaderBytes;
    const auto type = synchronised ? static_cast<std::uint8_t>(bytes[at + 2]) : std::uint8_t{0};
    const auto found = formats.find(type);
    const std::size_t size = type == kFormatType      ? kFormatBytes
                             : found == formats.end() ? 0
                                                      : found->second.bytes;
    if (!synchronised || size == 0 || size > bytes.size() - at) {
      const std::size_t next = std::min(bytes.find(kSync, at + 1), bytes.size());
      skipped += next - at;
      at = next;
      continue;
    }
    AWMR_RETURN_IF_ERROR(take(type, bytes.substr(at + kHeaderBytes, size - kHeaderBytes), at));
    at += size;
  }
  return skipped;
}

std::uint8_t instance_in(const Format& format, std::string_view record) {
  if (!format.instance) return 0;
  return static_cast<std::uint8_t>(record[format.fields[*format.instance].offset]);
}

/// A type of record and the instance it is of: a topic.
using TopicKey = std::pair<std::uint8_t, std::uint8_t>;

/// What the first pass over the file finds: its formats, and which topics have records.
struct Contents {
  Formats formats = {};
  std::map<TopicKey, std::size_t> topics = {};  ///< the number of their records
  std::size_t skipped = 0;
};

Result<Contents> contents_of(std::string_view bytes, const std::string& file) {
  Contents contents;
  Formats& formats = contents.formats;
  const auto define = [&](std::uint8_t type, std::string_view record,
                          std::size_t offset) -> Status {
    if (type == kFormatType) {
      auto format = format_of(record);
      if (!format) return input_error(file, fmt::format("byte {}: {}", offset, format.error()));
      const auto defined = static_cast<std::uint8_t>(record[0]);
      const auto [known, is_new] = formats.try_emplace(defined, *std::move(format));
      if (!is_new && known->second.definition != record) {
        return input_error(file, fmt::format("byte {}: a second, other format of {}", offset,
                                             printable(known->second.name)));
      }
    } else if (const Format& format = formats.at(type); format.name == "FMTU") {
      mark_instance(record, format, formats);
    }
    return {};
  };
  AWMR_ASSIGN_OR_RETURN(contents.skipped, for_each_record(bytes, formats, define));
  const auto count = [&](std::uint8_t type, std::string_view record, std::size_t) -> Status {
    if (type == kFormatType) return {};
    const Format& format = formats.at(type);
    if (format.time) ++contents.topics[{type, instance_in(format, record)}];
    return {};
  };
  AWMR_RETURN_IF_ERROR(for_each_record(bytes, formats, count));
  return contents;
}

/// A topic with what is wanted of it.
struct Listed {
  std::size_t topic = 0;             ///< in Signals::topics
  std::vector<const Field*> wanted;  ///< in the order of its columns
};

std::map<TopicKey, Listed> list_topics(const Contents& contents, const Wanted& wanted,
                                       Signals& signals) {
  std::map<TopicKey, Listed> listed;
  for (const auto& [key, records] : contents.topics) {
    const Format& format = contents.formats.at(key.first);
    Topic topic{.name = format.name};
    if (key.second != 0) topic.name += fmt::format("[{}]", key.second);
    Listed entry{.topic = signals.topics.size(), .wanted = {}};
    for (std::size_t i = 0; i < format.fields.size(); ++i) {
      const Field& field = format.fields[i];
      if (i == *format.time || i == format.instance || field.kind->scale == 0.0) continue;
      const std::string& name = signals.header.emplace_back(topic.name + "." + field.name);
      if (!wanted(name)) continue;
      topic.columns.push_back(signals.header.size() - 1);
      topic.values.emplace_back();
      entry.wanted.push_back(&field);
    }
    signals.topics.push_back(std::move(topic));
    listed.emplace(key, std::move(entry));
  }
  return listed;
}

/// The time of a record, ns; nothing where it cannot be one.
std::optional<std::int64_t> time_of(const Format& format, std::string_view record) {
  const Field& field = format.fields[*format.time];
  const double unit_ns = field.name == "TimeUS" ? 1e3 : 1e6;
  if (field.kind->character != 'Q' && field.kind->character != 'I') return std::nullopt;
  const std::uint64_t ticks = field.kind->character == 'Q'
                                  ? number_in<std::uint64_t>(record.substr(field.offset))
                                  : number_in<std::uint32_t>(record.substr(field.offset));
  if (static_cast<double>(ticks) * unit_ns > 9e18) return std::nullopt;
  return static_cast<std::int64_t>(ticks) * static_cast<std::int64_t>(unit_ns);
}

}  // namespace

bool is_dataflash(std::string_view bytes) {
  return bytes.starts_with(kSync) && bytes.size() > 2 &&
         static_cast<std::uint8_t>(bytes[2]) == kFormatType;
}

Result<Signals> read_dataflash(std::string_view bytes, const std::string& file,
                               const Wanted& wanted) {
  AWMR_ASSIGN_OR_RETURN(const Contents contents, contents_of(bytes, file));
  Signals signals;
  const std::map<TopicKey, Listed> listed = list_topics(contents, wanted, signals);
  if (signals.header.size() > kMostSignals) {
    return input_error(file, fmt::format("there are more than {} signals", kMostSignals));
  }
  const auto take = [&](std::uint8_t type, std::string_view record, std::size_t offset) -> Status {
    if (type == kFormatType) return {};
    const Format& format = contents.formats.at(type);
    const auto entry = listed.find({type, instance_in(format, record)});
    if (entry == listed.end() || entry->second.wanted.empty()) return {};
    const auto time_ns = time_of(format, record);
    if (!time_ns) {
      return input_error(file, fmt::format("byte {}: a record of {} has no time that can be",
                                           offset, printable(format.name)));
    }
    Topic& topic = signals.topics[entry->second.topic];
    topic.time_ns.push_back(*time_ns);
    for (std::size_t i = 0; i < entry->second.wanted.size(); ++i) {
      const Field& field = *entry->second.wanted[i];
      topic.values[i].push_back(value_in(record.substr(field.offset), *field.kind));
    }
    return {};
  };
  AWMR_RETURN_IF_ERROR(for_each_record(bytes, contents.formats, take));
  if (contents.skipped > 0) {
    signals.notes.push_back({0, "log-damaged",
                             fmt::format("{} of {} bytes belong to no record and are passed over",
                                         contents.skipped, bytes.size())});
  }
  return signals;
}

}  // namespace awmr
