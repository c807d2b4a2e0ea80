#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "awmr/core/text.h"
#include "byte_reader.h"
#include "dataflash_format.h"
#include "log_formats.h"

namespace awmr {
namespace {

// Every record begins with these two bytes and its type. An FMT record defines the length and the
// fields of one type.
constexpr std::string_view kRecordSync("\xA3\x95", 2);
constexpr std::uint8_t kFormatType = 128;
constexpr std::size_t kFormatBytes = 89;

/// Finds the field of a record type that numbers similar sensors: an FMTU record (TimeUS, type,
/// units, multipliers) marks it with the unit '#'. Stores the field as Format::instance of the
/// type.
void mark_instance(std::string_view record, const dataflash::Format& fmtu,
                   dataflash::Formats& formats) {
  std::optional<std::uint8_t> type;
  std::string units;
  for (const dataflash::Field& field : fmtu.fields) {
    const std::string_view bytes = record.substr(field.offset, field.kind->bytes);
    if (field.name == "FmtType") type = static_cast<std::uint8_t>(bytes[0]);
    if (field.name == "UnitIds") units = dataflash::text_of(bytes);
  }
  const auto found = type ? formats.find(*type) : formats.end();
  const std::size_t mark = units.find('#');
  if (found == formats.end() || mark >= found->second.fields.size()) return;
  if (found->second.fields[mark].kind->bytes == 1) found->second.instance = mark;
}

/// Calls `take(type, record, offset)` for every record of a known format. `take` may add formats.
/// Returns the number of bytes skipped.
template <class Take>
Result<std::size_t> for_each_record(std::string_view bytes, const dataflash::Formats& formats,
                                    const Take& take) {
  std::size_t skipped = 0;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const bool synchronised =
        bytes.substr(at, 2) == kRecordSync && bytes.size() - at >= dataflash::kRecordHeaderBytes;
    const auto type = synchronised ? static_cast<std::uint8_t>(bytes[at + 2]) : std::uint8_t{0};
    const auto found = formats.find(type);
    const std::size_t size = type == kFormatType      ? kFormatBytes
                             : found == formats.end() ? 0
                                                      : found->second.bytes;
    if (!synchronised || size == 0 || size > bytes.size() - at) {
      const std::size_t next = std::min(bytes.find(kRecordSync, at + 1), bytes.size());
      skipped += next - at;
      at = next;
      continue;
    }
    AWMR_RETURN_IF_ERROR(
        take(type,
             bytes.substr(at + dataflash::kRecordHeaderBytes, size - dataflash::kRecordHeaderBytes),
             at));
    at += size;
  }
  return skipped;
}

std::uint8_t instance_in(const dataflash::Format& format, std::string_view record) {
  if (!format.instance) return 0;
  return static_cast<std::uint8_t>(record[format.fields[*format.instance].offset]);
}

/// Identifies a topic (one signal source): record type, and number of the sensor.
using TopicKey = std::pair<std::uint8_t, std::uint8_t>;

/// Formats and topics of the file, which must be known before its values are read.
struct Contents {
  dataflash::Formats formats = {};
  std::set<TopicKey> topics = {};
  std::size_t skipped = 0;  ///< bytes that belong to no record
};

Result<Contents> contents_of(std::string_view bytes, const std::string& file) {
  Contents contents;
  dataflash::Formats& formats = contents.formats;
  const auto define = [&](std::uint8_t type, std::string_view record,
                          std::size_t offset) -> Status {
    if (type == kFormatType) {
      auto format = dataflash::format_of(record);
      if (!format) {
        return input_error(ErrorCode::kBrokenFile, file,
                           fmt::format("byte {}: {}", offset, format.error()));
      }
      const auto defined = static_cast<std::uint8_t>(record[0]);
      const auto [known, is_new] = formats.try_emplace(defined, *std::move(format));
      if (!is_new && known->second.definition != record) {
        return input_error(ErrorCode::kBrokenFile, file,
                           fmt::format("byte {}: a second definition (FMT record) of {} "
                                       "differs from the first definition; give each log as a file "
                                       "of its own",
                                       offset, printable(known->second.name)));
      }
    } else if (const dataflash::Format& format = formats.at(type); format.name == "FMTU") {
      mark_instance(record, format, formats);
    }
    return {};
  };
  AWMR_ASSIGN_OR_RETURN(contents.skipped, for_each_record(bytes, formats, define));
  const auto add_topic = [&](std::uint8_t type, std::string_view record, std::size_t) -> Status {
    if (type == kFormatType) return {};
    const dataflash::Format& format = formats.at(type);
    if (format.time) contents.topics.emplace(type, instance_in(format, record));
    return {};
  };
  AWMR_RETURN_IF_ERROR(for_each_record(bytes, formats, add_topic));
  return contents;
}

/// Time of a record, ns; empty if invalid.
std::optional<std::int64_t> time_of(const dataflash::Format& format, std::string_view record) {
  const dataflash::Field& field = format.fields[*format.time];
  if (field.kind->character != 'Q' && field.kind->character != 'I') return std::nullopt;
  const std::uint64_t ticks = field.kind->character == 'Q'
                                  ? number_in<std::uint64_t>(record.substr(field.offset))
                                  : number_in<std::uint32_t>(record.substr(field.offset));
  return dataflash::nanoseconds(format, ticks);
}

}  // namespace

bool is_dataflash(std::string_view bytes) {
  return bytes.starts_with(kRecordSync) && bytes.size() > 2 &&
         static_cast<std::uint8_t>(bytes[2]) == kFormatType;
}

Result<Signals> read_dataflash(std::string_view bytes, const std::string& file,
                               const Wanted& wanted) {
  AWMR_ASSIGN_OR_RETURN(const Contents contents, contents_of(bytes, file));
  Signals signals;
  std::map<TopicKey, dataflash::ListedTopic> listed;
  for (const TopicKey& key : contents.topics) {
    const auto& [type, sensor] = key;
    listed.emplace(key, dataflash::list_topic(contents.formats.at(type), sensor, wanted, signals));
  }
  AWMR_RETURN_IF_ERROR(dataflash::check_count(signals, file));
  const auto take = [&](std::uint8_t type, std::string_view record, std::size_t offset) -> Status {
    if (type == kFormatType) return {};
    const dataflash::Format& format = contents.formats.at(type);
    const auto entry = listed.find({type, instance_in(format, record)});
    if (entry == listed.end() || entry->second.fields.empty()) return {};
    const auto time_ns = time_of(format, record);
    if (!time_ns) {
      return input_error(ErrorCode::kBrokenFile, file,
                         fmt::format("byte {}: a record of {} has an invalid time", offset,
                                     printable(format.name)));
    }
    Topic& topic = signals.topics[entry->second.topic];
    topic.time_ns.push_back(*time_ns);
    for (std::size_t i = 0; i < entry->second.fields.size(); ++i) {
      const dataflash::Field& field = format.fields[entry->second.fields[i]];
      topic.values[i].push_back(field.kind->scale * field.kind->read(record.substr(field.offset)));
    }
    return {};
  };
  AWMR_RETURN_IF_ERROR(for_each_record(bytes, contents.formats, take));
  if (contents.skipped > 0) {
    signals.notes.push_back({0, "log-damaged",
                             fmt::format("{} of {} bytes belong to no record and are skipped",
                                         contents.skipped, bytes.size())});
  }
  return signals;
}

}  // namespace awmr
