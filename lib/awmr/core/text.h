/// Prepares text for messages and terminals: escapes control characters, shortens long text, breaks
/// it into lines, checks UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace awmr {

/// True for the second and later bytes of a UTF-8 character (10xxxxxx).
inline bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// True for 0 to 9, whatever the locale.
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_utf8(std::string_view text);

/// The beginning of a text: at most `longest` bytes, without cutting a UTF-8 character.
std::string_view first_characters(std::string_view text, std::size_t longest);

/// The text on one line, safe to print on a terminal. Control characters, marks that change the
/// writing direction and bytes that are not UTF-8 are escaped: `\n`, `\t`, `\u{202e}`, `\xff`.
std::string printable(std::string_view text);

/// As printable(), but keeps line breaks.
std::string printable_lines(std::string_view text);

/// Breaks a text between words into lines of at most `width` bytes, and indents all lines but the
/// first by `indent` spaces. The first line is shorter by `indent`, for a text that the caller puts
/// before it.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width);
/// The text as a paragraph of a terminal: wrapped to lines of 100 bytes, all indented by `indent`
/// spaces, and a line break.
std::string paragraph(const std::string& text, std::size_t indent);

/// Joins the words of the items for a sentence, with `last` before the last word: "a, b or c" for
/// " or ".
template <class Items, class WordOf>
std::string enumerated(const Items& items, const WordOf& word_of, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? last : ", ";
    text += word_of(items[i]);
  }
  return text;
}

/// Default length limit of shortened(), bytes.
inline constexpr std::size_t kLongestShown = 1000;

/// The text; if it has more than `longest` bytes, only its beginning, " ... " and its end, where a
/// message has its remedy.
std::string shortened(std::string_view text, std::size_t longest = kLongestShown);

}  // namespace awmr
