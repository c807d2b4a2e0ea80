/// `--shard`, which the commands take that several machines can share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "awmr/core/result.h"
#include "awmr/core/shard.h"
#include "console.h"

namespace awmr::cli {

/// What is run of the work; none: all of it, to the files of a single run.
using ShardChoice = std::optional<Shard>;

inline CLI::Option* add_shard(CLI::App& command, std::optional<std::string>& text) {
  return command.add_option(
      "--shard", text,
      "I/N: part I of N, for as many machines; awmr merge puts the parts together");
}

/// Errors (input): a text that is not I/N.
Result<ShardChoice> shard_of(const std::optional<std::string>& text);

/// Where `--resume` finds a finished part, which stays as it is.
Result<Outcome> finished_part(const Shard& shard, const std::filesystem::path& directory);

}  // namespace awmr::cli
