/// Parses the format definitions (FMT records) of an ArduPilot DataFlash log, and lists the signals
/// of its topics. Used for the binary form and the text form. Private to trials/.
///                                               [ArduPilot, libraries/AP_Logger/LogStructure.h]
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "signals.h"

namespace awmr::dataflash {

/// Each record begins with two bytes for synchronisation and one for its type.
inline constexpr std::size_t kRecordHeaderBytes = 3;

/// Number type of a field, which the format names by one character.
struct FieldKind {
  char character;
  std::size_t bytes;
  double scale;  ///< value = stored number times `scale`
  /// Returns the stored number at the beginning of the bytes; null: the field is not read.
  double (*read)(std::string_view bytes);
};
/// A named field of a record.
struct Field {
  std::string name;
  const FieldKind* kind = nullptr;
  std::size_t offset = 0;  ///< byte offset after the record header
};

/// Definition of a record type.
struct Format {
  std::string definition;  ///< bytes of the FMT record, without the record header
  std::string name;
  std::size_t bytes = 0;  ///< size of a record, with its header
  std::vector<Field> fields = {};
  /// Index in `fields` of the field with the time (TimeUS or TimeMS).
  std::optional<std::size_t> time = {};
  /// Index in `fields` of the instance number of the sensor.
  std::optional<std::size_t> instance = {};
};

/// Formats, by the record type (third byte of the record header).
using Formats = std::map<std::uint8_t, Format>;

/// Text in a field of fixed size, up to its first NUL.
std::string text_of(std::string_view bytes);

/// Parses the 86 bytes after the header of an FMT record: type, length, name[4], format[16],
/// labels[64]. Errors: `labels` and `format` have different numbers of fields; an unknown format
/// character; a length that is not that of the fields.
tl::expected<Format, std::string> format_of(std::string_view bytes);

/// The parts of the text between its commas; one empty part for an empty text.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// Converts the value of the time field to ns; empty if it is too large.
std::optional<std::int64_t> nanoseconds(const Format& format, std::uint64_t ticks);

/// A topic in Signals: the records of one type and one sensor.
struct ListedTopic {
  std::size_t topic = 0;  ///< index in Signals::topics
  /// Requested fields, as indices in Format::fields, in the order of Topic::columns.
  std::vector<std::size_t> fields = {};
};

/// Adds a topic and the names of its signals to `signals`: `NAME.FIELD`, or `NAME[2].FIELD` for
/// sensor 2. Precondition: the format has a time.
ListedTopic list_topic(const Format& format, std::uint8_t sensor, const Wanted& wanted,
                       Signals& signals);

/// Checks that there are at most kMaxSignals signals. Error (input): there are more.
Status check_count(const Signals& signals, const std::string& file);

}  // namespace awmr::dataflash
