/// Colours for text on a terminal.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace awmr::cli {

/// True if the stream is a terminal that can move its cursor and show colours: TERM is not "dumb".
bool is_terminal(std::FILE* stream);

/// Adds terminal colours to text for a stream. Leaves the text unchanged if is_terminal() is false,
/// or if the environment variable NO_COLOR is not empty [no-color.org].
class Style {
 public:
  explicit Style(std::FILE* stream);

  std::string bold(std::string_view text) const { return in("1", text); }
  std::string error(std::string_view text) const { return in("1;31", text); }
  std::string warning(std::string_view text) const { return in("1;33", text); }
  std::string note(std::string_view text) const { return in("36", text); }
  std::string faint(std::string_view text) const { return in("2", text); }

 private:
  std::string in(std::string_view code, std::string_view text) const;
  bool on_ = false;
};

}  // namespace awmr::cli
