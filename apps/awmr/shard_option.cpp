#include "shard_option.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

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
  return input_error(
      ErrorCode::kWrongType, "--shard",
      fmt::format("'{}' is not of the form I/N (part I of N): give for example 1/4", *text));
}

Result<Outcome> written_part(const ShardKind& kind, const Shard& shard,
                             const std::filesystem::path& directory, const PartText& part,
                             const std::string& content, std::vector<Finding> findings) {
  AWMR_RETURN_IF_ERROR(write_part(kind, directory, part));
  Outcome outcome{.findings = std::move(findings), .document = part.shard_json};
  outcome.written = {directory / kShardFile, directory / kind.table};
  outcome.summary = fmt::format("part {} of {}: {}\nwrote {} and {}\n", shard.index, shard.count,
                                content, outcome.written.front().string(), kind.table);
  return outcome;
}

}  // namespace awmr::cli
