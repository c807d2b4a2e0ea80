#include "dataflash_format.h"

#include <fmt/format.h>

#include <array>

#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr::dataflash {
namespace {

template <class T>
constexpr FieldKind kind(char character, double scale = 1.0) {
  return {character, sizeof(T), scale, read_number<T>};
}

/// A text, an array or a number of 16 bits with a decimal point.
constexpr FieldKind skipped(char character, std::size_t bytes) {
  return {character, bytes, 0.0, nullptr};
}

/// Kinds c, C, e and E are hundredths; L is 1e-7 degrees.
constexpr std::array<FieldKind, 21> kKinds{
    kind<std::int8_t>('b'),        kind<std::uint8_t>('B'),        kind<std::uint8_t>('M'),
    kind<std::int16_t>('h'),       kind<std::uint16_t>('H'),       kind<std::int32_t>('i'),
    kind<std::uint32_t>('I'),      kind<std::int64_t>('q'),        kind<std::uint64_t>('Q'),
    kind<float>('f'),              kind<double>('d'),              kind<std::int16_t>('c', 0.01),
    kind<std::uint16_t>('C', 0.01), kind<std::int32_t>('e', 0.01), kind<std::uint32_t>('E', 0.01),
    kind<std::int32_t>('L', 1e-7), skipped('a', 64),               skipped('n', 4),
    skipped('N', 16),              skipped('Z', 64),               skipped('g', 2)};

const FieldKind* kind_of(char character) {
  for (const FieldKind& kind : kKinds) {
    if (kind.character == character) return &kind;
  }
  return nullptr;
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

}  // namespace

std::string text_of(std::string_view bytes) {
  return std::string(bytes.substr(0, bytes.find('\0')));
}

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
  if (format.bytes != end + kRecordHeaderBytes) {
    return tl::unexpected(fmt::format("{} declares {} bytes, but header and fields have {}", shown,
                                      format.bytes, end + kRecordHeaderBytes));
  }
  return format;
}

}  // namespace awmr::dataflash
