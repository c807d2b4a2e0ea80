#include "awmr/core/csv_blocks.h"

#include <algorithm>
#include <atomic>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "awmr/core/cell_places.h"
#include "awmr/core/csv_block.h"
#include "awmr/core/csv_header.h"
#include "awmr/core/csv_text.h"
#include "awmr/core/hash.h"
#include "awmr/core/in_order.h"
#include "awmr/core/input_file.h"
#include "awmr/core/line_block.h"
#include "awmr/core/parallel.h"
#include "awmr/core/raw_table.h"

namespace awmr {
namespace {

/// File format, determined from its beginning.
struct Beginning {
  CsvHeader header = {};  ///< without `cells`, whose text is no longer in memory
  std::size_t first_row = 0;
  int first_line = 1;
};

/// Reads as much of the file as the header needs. Nothing if there is no header or if it does not
/// end.
Result<std::optional<Beginning>> beginning_of(const InputBytes& file,
                                              std::span<const CsvColumn> columns,
                                              std::span<const ColumnMapping> mappings) {
  constexpr std::size_t kLongestBeginning = std::size_t{1} << 22U;
  for (std::size_t size = 4096; size <= kLongestBeginning; size *= 4) {
    std::string bytes(std::min(size, file.size()), '\0');
    AWMR_RETURN_IF_ERROR(file.read(0, bytes));
    const bool is_whole = bytes.size() == file.size();
    std::string_view text = bytes;
    if (!is_whole) text = text.substr(0, text.rfind('\n') + 1);
    if (text.find('\0') != std::string_view::npos) return std::nullopt;
    text.remove_prefix(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    CsvScanner scanner(text);
    auto header = find_header(scanner, file.name(), columns, mappings);
    if (header && (is_whole || !header->is_cut)) {
      header->cells.clear();
      const auto end = static_cast<std::size_t>(text.data() + text.size() - bytes.data());
      return Beginning{std::move(*header), end - scanner.left(), scanner.line()};
    }
    if (is_whole) break;
  }
  return std::nullopt;
}

/// Rows collected from the blocks, in order.
struct Gathered {
  RawTable raw;
  Sha256 hash = {};
  int next_line = 1;
};

/// Reserves memory for the remaining rows, estimated from those so far. Unwritten memory costs
/// nothing.
void reserve(std::vector<double>& values, std::size_t more, double share_read) {
  if (values.size() + more <= values.capacity()) return;
  const double all = static_cast<double>(values.size() + more) / share_read;
  values.reserve(std::max(static_cast<std::size_t>(1.05 * all) + 1, values.capacity() * 3 / 2));
}

void take_lines(const CsvBlock& block, Gathered& gathered) {
  std::size_t done = 0;
  const auto take_until = [&](std::size_t line) {
    gathered.raw.lines.append(gathered.next_line + static_cast<int>(done), line - done);
    done = line + 1;
  };
  for (const std::size_t line : block.without_row()) take_until(line);
  take_until(block.lines());
  gathered.next_line += static_cast<int>(block.lines());
}

void take(const CsvBlock& block, std::span<const CsvUsedColumn> used, double share_read,
          Gathered& gathered) {
  take_lines(block, gathered);
  gathered.raw.may_have_empty = gathered.raw.may_have_empty || block.has_empty();
  for (std::size_t place = 0; place < used.size(); ++place) {
    std::vector<double>& all = gathered.raw.columns[used[place].index].value;
    const std::span<const double> values = block.values(place);
    reserve(all, values.size(), share_read);
    all.insert(all.end(), values.begin(), values.end());
  }
}

int threads_for(const InputBytes& file, const CsvBlocks& blocks) {
  constexpr std::size_t kSmallFile = std::size_t{1} << 23U;
  constexpr unsigned kMostThreads = 4;  // hashing is sequential and keeps no more threads busy
  if (blocks.threads > 0) return blocks.threads;
  if (file.size() < kSmallFile) return 1;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads));
}

/// Reads all rows; false if a line needs the whole-text reader.
Result<bool> read_rows(const InputBytes& file, std::size_t first_row, const CsvShape& shape,
                       const CsvBlocks& blocks, Gathered& gathered) {
  const std::size_t count = (file.size() + blocks.bytes - 1) / blocks.bytes;
  std::atomic<std::size_t> next = 0;
  InOrder order;
  const auto work = [&] {
    LineBlock lines;
    CsvBlock rows;
    for (std::size_t i = next++; i < count; i = next++) {
      const std::size_t end = std::min((i + 1) * blocks.bytes, file.size());
      const Status read = lines.read(file, first_row, i * blocks.bytes, end);
      const bool is_ordinary = read && !lines.is_too_long() && rows.read(lines.lines(), shape);
      const bool goes_on = order.take(i, [&] {
        if (!read) return order.fail(read.error());
        if (!is_ordinary) return order.end();
        if (file.is_file() && blocks.hash) gathered.hash.add(lines.bytes());
        take(rows, shape.used, static_cast<double>(end) / static_cast<double>(file.size()),
             gathered);
      });
      if (!goes_on) return;
    }
  };
  const int threads = threads_for(file, blocks);
  parallel_for(static_cast<std::size_t>(threads), threads, [&](std::size_t) { order.guard(work); });
  return order.outcome();
}

}  // namespace

Result<std::optional<CsvTable>> read_csv_blocks(std::shared_ptr<const InputBytes> bytes,
                                                std::span<const CsvColumn> columns,
                                                std::span<const ColumnMapping> mappings,
                                                const CsvBlocks& blocks) {
  AWMR_ASSIGN_OR_RETURN(const std::optional<Beginning> begin,
                        beginning_of(*bytes, columns, mappings));
  if (!begin) return std::nullopt;
  const CsvHeader& header = begin->header;
  ColumnSources sources =
      find_columns(header.names, header.samples, columns, mappings, bytes->name());
  if (!sources.faults.empty()) return std::nullopt;
  const std::vector<CsvUsedColumn> used = used_columns(sources, header.names);
  const CsvShape shape{.delimiter = header.delimiter, .cells = header.names.size(), .used = used};
  Gathered gathered{.raw = {.file = bytes->name(),
                            .header_line = header.line,
                            .columns = std::vector<RawColumn>(header.names.size()),
                            .notes = format_notes(header, false),
                            .may_have_empty = false},
                    .next_line = begin->first_line};
  AWMR_ASSIGN_OR_RETURN(const bool is_ordinary,
                        read_rows(*bytes, begin->first_row, shape, blocks, gathered));
  AWMR_RETURN_IF_ERROR(bytes->check_unchanged());
  if (!is_ordinary) return std::nullopt;
  if (bytes->is_file() && blocks.hash) note_input(bytes->name(), gathered.hash.hex());
  gathered.raw.places = std::make_shared<const CellPlaces>(bytes, begin->first_row,
                                                           begin->first_line, header.delimiter);
  auto table = table_of(std::move(gathered.raw), std::move(sources), mappings, {});
  if (!table) return std::nullopt;
  return std::optional<CsvTable>(std::move(*table));
}

}  // namespace awmr
