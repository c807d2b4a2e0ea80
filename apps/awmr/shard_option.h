/// Option `--shard` of the commands whose work can be divided among machines.
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

/// Part of the work that this call executes; empty: all work.
using ShardChoice = std::optional<Shard>;

inline CLI::Option* add_shard(CLI::App& command, std::optional<std::string>& text) {
  return command.add_option("--shard", text,
                            "I/N: run part I of N, for N machines; awmr merge combines the parts");
}

/// Parses the text I/N, which stands for part I of N. Errors (input): the text is not of this form.
Result<ShardChoice> shard_of(const std::optional<std::string>& text);

/// Writes the results of one part into the directory. `content`: description of these results, such
/// as "5 runs". Errors: those of write_part().
Result<Outcome> written_part(const ShardKind& kind, const Shard& shard,
                             const std::filesystem::path& directory, const PartText& part,
                             const std::string& content, std::vector<Finding> findings = {});

}  // namespace awmr::cli
