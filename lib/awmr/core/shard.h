/// Shards: parts of one job for several machines. A shard has every count-th item.
#pragma once

#include <optional>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// One of `count` shards: every item i, from 0, with i mod count = index - 1.
struct Shard {
  int index = 1;  ///< 1 ... count
  int count = 1;
  bool has(int item) const { return item >= 0 && item % count == index - 1; }
  /// Number of the shard's items, of `items` in total.
  int share_of(int items) const { return items < index ? 0 : (items - index) / count + 1; }
  /// Global index of the shard's i-th item, from 0.
  int item(int i) const { return index - 1 + i * count; }
};

/// Fault of a shard of `items` items: each shard needs at least one. `kind` names the items:
/// "runs".
std::optional<Fault> shard_fault(const Shard& shard, long items, std::string_view kind);

}  // namespace awmr
