/// Text of a user's files as it may be shown: it steers no terminal and fills no screen.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace awmr {

/// The second and later bytes of a UTF-8 character are 10xxxxxx.
inline bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Whatever the language of the system.
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_utf8(std::string_view text);

/// The first `longest` bytes of a text, or fewer: it is never cut inside a UTF-8 character.
std::string_view first_characters(std::string_view text, std::size_t longest);

/// The text on one line: control characters, the marks that turn the direction of writing and bytes
/// that are no UTF-8 as `\n`, `\t`, `\u{202e}`, `\xff`.
std::string printable(std::string_view text);

/// As `printable`, but lines stay lines.
std::string printable_lines(std::string_view text);

/// The longest text that `shortened` leaves as it is, in bytes.
inline constexpr std::size_t kLongestShown = 1000;

/// The text, or where it is longer than `longest` its beginning and its end, as the end of a
/// message says what to do.
std::string shortened(std::string_view text, std::size_t longest = kLongestShown);

}  // namespace awmr
