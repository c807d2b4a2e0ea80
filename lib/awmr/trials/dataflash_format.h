/// The formats that an ArduPilot DataFlash log defines for its records (FMT) and the kinds of their
/// fields. Private to this folder. [ArduPilot, libraries/AP_Logger/LogStructure.h]
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace awmr::dataflash {

inline constexpr std::size_t kRecordHeaderBytes = 3;  ///< two of synchronisation and the type

/// A character of a record's format.
struct FieldKind {
  char character;
  std::size_t bytes;
  double scale;  ///< 0: a text
};
/// A named value of a record.
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

/// By the type that stands in a record's header.
using Formats = std::map<std::uint8_t, Format>;

/// The number of this kind at the beginning of the bytes, scaled.
double value_in(std::string_view bytes, const FieldKind& kind);

/// The text of a fixed number of bytes, up to its first NUL.
std::string text_of(std::string_view bytes);

/// A format from the 86 bytes behind the header of an FMT record: type, length, name[4], format[16],
/// labels[64]. Errors: names and kinds that do not agree, an unknown kind, another length.
tl::expected<Format, std::string> format_of(std::string_view bytes);

}  // namespace awmr::dataflash
