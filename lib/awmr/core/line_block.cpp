#include "awmr/core/line_block.h"

#include <algorithm>
#include <span>
#include <utility>

namespace awmr {
namespace {

constexpr std::size_t kTail = 512;  ///< read behind a block: contains the rest of most lines

}  // namespace

Status LineBlock::read(const InputBytes& file, std::size_t first, std::size_t begin,
                       std::size_t end) {
  // The byte before the block shows whether a line begins with the block.
  const std::size_t from = begin == 0 ? 0 : begin - 1;
  std::size_t have = 0;
  const auto read_until = [&](std::size_t until) -> Status {
    buffer_.resize(std::max(buffer_.size(), until - from + 1 + kPadding));
    const std::size_t before = std::exchange(have, until - from);
    return file.read(from + before, std::span(buffer_).subspan(before, have - before));
  };
  const auto text = [&] { return std::string_view(buffer_.data(), have); };
  AWMR_RETURN_IF_ERROR(read_until(std::min(end + kTail, file.size())));
  lines_ = {};
  is_too_long_ = false;
  bytes_ = text().substr(begin - from, end - begin);
  // The first row can be the text's first line if there is no header.
  const bool has_first = first > from || begin == 0;
  const std::size_t start = has_first ? first - from : text().find('\n') + 1;
  const bool is_inside_a_line = !has_first && start == 0;
  if (is_inside_a_line || from + start >= end) return {};
  std::size_t stop = text().find('\n', end - 1 - from);
  for (std::size_t tail = 4 * kTail; stop == std::string_view::npos; tail *= 4) {
    if (from + have == file.size()) {
      buffer_[stop = have] = '\n';
      break;
    }
    is_too_long_ = tail > kLongestLine;
    if (is_too_long_) return {};
    AWMR_RETURN_IF_ERROR(read_until(std::min(end + tail, file.size())));
    stop = text().find('\n', end - 1 - from);
  }
  bytes_ = text().substr(begin - from, end - begin);
  lines_ = std::string_view(buffer_.data() + start, stop + 1 - start);
  return {};
}

}  // namespace awmr
