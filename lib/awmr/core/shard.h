/// Work in parts, on as many machines: a part has every count-th item of it.
#pragma once

#include <optional>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// The file of a part that says where it is from and which one it is.
inline constexpr const char* kShardFile = "shard.json";

/// One of `count` parts: every item i, from 0, with i mod count = index - 1.
struct Shard {
  int index = 1;  ///< 1 ... count
  int count = 1;
  bool has(int item) const { return item >= 0 && item % count == index - 1; }
  /// How many of `items` items it has.
  int share_of(int items) const { return items < index ? 0 : (items - index) / count + 1; }
  /// The place among all of the part's ith item, from 0.
  int item(int i) const { return index - 1 + i * count; }
};

/// What is wrong with a part of `items` items, at least one in each; `kind` names them in words:
/// "runs".
std::optional<Fault> shard_fault(const Shard& shard, long items, std::string_view kind);

}  // namespace awmr
