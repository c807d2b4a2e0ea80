/// Divides a job with many items (simulation runs, sampled vehicles) into shards. Each shard can be
/// processed on another machine.
#pragma once

#include <optional>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// Shard `index` of `count`. It has the items i = 0, 1, ... of the job with
/// i mod count = index - 1.
struct Shard {
  int index = 1;  ///< 1 ... count
  int count = 1;
  bool has(int item) const { return item >= 0 && item % count == index - 1; }
  /// Number of items of this shard if the job has `items` items.
  int share_of(int items) const { return items < index ? 0 : (items - index) / count + 1; }
  /// Index in the job of this shard's i-th item, i from 0.
  int item(int i) const { return index - 1 + i * count; }
};

/// Checks a shard of a job of `items` items. Returns a fault if its index is not in 1 ... count, or
/// if there are more shards than items; none if it is valid. `kind` names the items in the message:
/// "runs".
std::optional<Fault> shard_fault(const Shard& shard, long items, std::string_view kind);

}  // namespace awmr
