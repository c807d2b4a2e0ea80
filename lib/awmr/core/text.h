/// Sanitises user text for display: escapes control characters and shortens long text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace awmr {

/// The second and later bytes of a UTF-8 character are 10xxxxxx.
inline bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Independent of the system's locale.
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_utf8(std::string_view text);

/// The first `longest` bytes of a text, or fewer, so that no UTF-8 character is cut.
std::string_view first_characters(std::string_view text, std::size_t longest);

/// The text on one line. Control characters, marks that change the writing direction and bytes that
/// are not UTF-8 are written as `\n`, `\t`, `\u{202e}`, `\xff`.
std::string printable(std::string_view text);

/// As `printable`, but keeps line breaks.
std::string printable_lines(std::string_view text);

/// Maximum length that `shortened` leaves unchanged, in bytes.
inline constexpr std::size_t kLongestShown = 1000;

/// The text; if longer than `longest`, its beginning and its end, because a message ends with its
/// remedy.
std::string shortened(std::string_view text, std::size_t longest = kLongestShown);

}  // namespace awmr
