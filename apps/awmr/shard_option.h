/// `--shard` of the commands whose work can be split across machines.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "console.h"

namespace awmr::cli {

/// Shard of the work to run; empty: all of it, written to the files of a single run.
using ShardChoice = std::optional<Shard>;

inline CLI::Option* add_shard(CLI::App& command, std::optional<std::string>& text) {
  return command.add_option("--shard", text,
                            "I/N: run part I of N, for N machines; awmr merge combines the parts");
}

/// Errors (input): text that is not I/N.
Result<ShardChoice> shard_of(const std::optional<std::string>& text);

/// Outcome if `--resume` finds a finished part, which remains unchanged.
Result<Outcome> finished_part(const Shard& shard, const std::filesystem::path& directory);

/// Writes a part into the directory. `content` describes it: "5 runs". Errors: as write_part().
Result<Outcome> written_part(const ShardKind& kind, const Shard& shard,
                             const std::filesystem::path& directory, const PartText& part,
                             const std::string& content, std::vector<Finding> findings = {});

}  // namespace awmr::cli
