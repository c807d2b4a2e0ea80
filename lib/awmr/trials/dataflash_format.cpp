#include "dataflash_format.h"

#include <fmt/format.h>

#include <array>

#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr::dataflash {
namespace {

/// Kinds c, C, e and E are hundredths; L is 1e-7 degrees. Texts, arrays and 16-bit floats are not
/// read.
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
