#include "awmr/core/text.h"

#include <fmt/format.h>

#include <cstdint>
#include <sstream>

namespace awmr {
namespace {

struct Character {
  std::uint32_t code = 0;  ///< Unicode code point
  std::size_t bytes = 0;   ///< 0 if the text does not begin with UTF-8
};

/// Decodes the first UTF-8 character of a non-empty text.  [RFC 3629, section 3]
Character first_character(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text[0]);
  if (byte < 0x80U) return {byte, 1};
  const std::size_t bytes = byte >= 0xF0U ? 4 : byte >= 0xE0U ? 3 : 2;
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  if (byte < 0xC0U || byte > 0xF4U || text.size() < bytes) return {};
  std::uint32_t code = byte & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues_character(text[i])) return {};
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallest[bytes] || code > 0x10FFFF || is_surrogate) return {};
  return {code, bytes};
}

/// True for characters that move the cursor, change the terminal's state or reverse the writing
/// direction.
bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(std::string_view text, bool keep_lines) {
  std::string result;
  while (!text.empty()) {
    const Character next = first_character(text);
    const std::size_t bytes = next.bytes == 0 ? 1 : next.bytes;
    if (next.bytes == 0) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    } else if (!is_control(next.code) || (keep_lines && next.code == '\n')) {
      result += text.substr(0, bytes);
    } else if (next.code == '\n') {
      result += "\\n";
    } else if (next.code == '\r') {
      result += "\\r";
    } else if (next.code == '\t') {
      result += "\\t";
    } else {
      result += next.code < 0x80 ? fmt::format("\\x{:02x}", next.code)
                                 : fmt::format("\\u{{{:x}}}", next.code);
    }
    text.remove_prefix(bytes);
  }
  return result;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = first_character(text).bytes;
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::string_view first_characters(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return text;
  while (longest > 0 && continues_character(text[longest])) --longest;
  return text.substr(0, longest);
}

std::string printable(std::string_view text) { return escaped(text, false); }

std::string printable_lines(std::string_view text) { return escaped(text, true); }

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string result;
  std::size_t column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string paragraph(const std::string& text, std::size_t indent) {
  return std::string(indent, ' ') + wrapped(text, indent, 100) + '\n';
}

std::string shortened(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  const std::size_t end_bytes = longest / 3;
  std::size_t begin_of_end = text.size() - end_bytes;
  while (begin_of_end < text.size() && continues_character(text[begin_of_end])) ++begin_of_end;
  return fmt::format("{} ... {}", first_characters(text, longest - end_bytes),
                     text.substr(begin_of_end));
}

}  // namespace awmr
