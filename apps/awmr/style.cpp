#include "style.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace awmr::cli {

bool is_terminal(std::FILE* stream) {
  const char* term = std::getenv("TERM");
  return ::isatty(::fileno(stream)) == 1 && (term == nullptr || std::string_view(term) != "dumb");
}

Style::Style(std::FILE* stream) {
  const char* no_colour = std::getenv("NO_COLOR");
  const bool unwanted = no_colour != nullptr && *no_colour != '\0';
  on_ = !unwanted && is_terminal(stream);
}

std::string Style::in(std::string_view code, std::string_view text) const {
  return on_ ? fmt::format("\033[{}m{}\033[0m", code, text) : std::string(text);
}

}  // namespace awmr::cli
