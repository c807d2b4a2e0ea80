#include "awmr/core/cell_places.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/csv_scanner.h"

namespace awmr {
namespace {

constexpr std::size_t kPlacesBlock = std::size_t{1} << 18U;

/// Text of the line `skip` lines below the one that starts at byte `begin`.
std::optional<std::string> line_below(const InputBytes& bytes, std::size_t begin, int skip) {
  std::string line;
  std::string block;
  while (begin < bytes.size()) {
    block.resize(std::min(kPlacesBlock, bytes.size() - begin));
    if (!bytes.read(begin, block)) return std::nullopt;
    begin += block.size();
    std::size_t from = 0;
    for (; skip > 0 && from < block.size(); --skip) {
      const std::size_t end = block.find('\n', from);
      if (end == std::string::npos) break;
      from = end + 1;
    }
    if (skip > 0) continue;
    const std::size_t end = block.find('\n', from);
    line.append(block, from, end == std::string::npos ? end : end - from);
    if (end != std::string::npos) break;
  }
  return line;
}

}  // namespace

int CellPlaces::character(int line, std::size_t cell) const {
  const auto text = line_below(*bytes_, first_row_, line - first_line_);
  if (!text) return 1;
  CsvScanner scanner(*text);
  scanner.set_delimiter(delimiter_);
  std::vector<CsvCell> cells;
  if (scanner.next(cells) != CsvScanner::Outcome::kRecord || cell >= cells.size()) return 1;
  return cells[cell].character;
}

}  // namespace awmr
