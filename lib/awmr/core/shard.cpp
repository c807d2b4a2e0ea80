#include "awmr/core/shard.h"

#include <fmt/format.h>

#include "awmr/core/option_text.h"

namespace awmr {

std::optional<Fault> shard_fault(const Shard& shard, long items, std::string_view kind) {
  if (shard.index >= 1 && shard.index <= shard.count && shard.count <= items) return std::nullopt;
  return Fault{ErrorCode::kOutOfRange, option_text("shard"),
               fmt::format("found {}/{}; expected I/N with 1 <= I <= N, and N at most the {} {}",
                           shard.index, shard.count, items, kind)};
}

}  // namespace awmr
