#include "awmr/core/option_text.h"

#include <algorithm>
#include <cstddef>

namespace awmr {
namespace {

constexpr std::string_view kOpen = "{option:";
constexpr std::string_view kClose = "}";

/// An option as the user writes it. With the prefix "--", '-' replaces '_' in its name; its value
/// is unchanged.
std::string spelt(std::string_view option, std::string_view prefix) {
  std::string text(option);
  if (prefix == "--") {
    const auto end =
        text.begin() + static_cast<std::ptrdiff_t>(std::min(text.find(' '), text.size()));
    std::replace(text.begin(), end, '_', '-');
  }
  return text;
}

}  // namespace

std::string option_text(std::string_view name) {
  return std::string(kOpen).append(name).append(kClose);
}

std::string replace_options(std::string_view message,
                            const std::function<std::string(std::string_view option)>& spelling) {
  std::string text;
  while (true) {
    const std::size_t open = message.find(kOpen);
    const std::size_t close = open == std::string_view::npos ? open : message.find(kClose, open);
    if (close == std::string_view::npos) return text.append(message);
    const std::size_t name = open + kOpen.size();
    text.append(message.substr(0, open)).append(spelling(message.substr(name, close - name)));
    message.remove_prefix(close + kClose.size());
  }
}

std::string spell_options(std::string_view message, std::string_view prefix) {
  return replace_options(message, [prefix](std::string_view option) {
    return std::string(prefix).append(spelt(option, prefix));
  });
}

}  // namespace awmr
