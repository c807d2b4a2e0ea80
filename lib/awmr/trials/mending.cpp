#include "mending.h"

#include <fmt/format.h>

#include "awmr/core/option_text.h"
#include "awmr/trials/log_evidence.h"

namespace awmr {

std::string mapped_by(std::span<const Mending> mendings, std::span<const ColumnMapping> mappings,
                      bool in_doubt) {
  std::string text;
  for (const Mending& mending : mendings) {
    const std::string option =
        option_text("column '" +
                    scaled_mapping(mappings, mending.column, mending.factor, mending.offset) + "'");
    text += fmt::format("{}by {}", text.empty() ? "map it " : " or ", option);
    if (in_doubt || mendings.size() > 1) text += fmt::format(" ({})", mending.words);
  }
  return text;
}

std::string words_of(std::span<const Mending> mendings) {
  std::string text;
  for (std::size_t i = 0; i < mendings.size(); ++i) {
    const bool is_last = i + 1 == mendings.size();
    text += fmt::format("{}{}", i == 0 ? "" : is_last ? " or " : ", ", mendings[i].words);
  }
  return text;
}

}  // namespace awmr
