#include "shard_option.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "awmr/core/file.h"

namespace awmr::cli {

Result<ShardChoice> shard_of(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  Shard shard;
  const char* end = text->data() + text->size();
  const auto [slash, first] = std::from_chars(text->data(), end, shard.index);
  if (first == std::errc{} && slash != end && *slash == '/') {
    const auto [rest, second] = std::from_chars(slash + 1, end, shard.count);
    if (second == std::errc{} && rest == end) return shard;
  }
  return input_error("--shard", fmt::format("'{}' is no part: give I/N, as 1/4", *text));
}

Result<Outcome> finished_part(const Shard& shard, const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / kShardFile;
  AWMR_ASSIGN_OR_RETURN(std::string document, read_file(file));
  return Outcome{.summary = fmt::format("part {} of {} is finished already: {}\n", shard.index,
                                        shard.count, file.string()),
                 .document = std::move(document)};
}

}  // namespace awmr::cli
