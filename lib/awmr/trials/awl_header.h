/// Header of an `.awl` file, which describes its rows. Private to this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/result.h"

namespace awmr::awl {

enum class Kind { kFloat, kUnsigned, kByte };
inline constexpr NameTable<Kind, 3> kKindNames{
    {{"f32", Kind::kFloat}, {"u32", Kind::kUnsigned}, {"u8", Kind::kByte}}};

struct Column {
  std::string name;
  Kind kind = Kind::kFloat;
  double scale = 1.0;      ///< unit of the stored counts
  std::size_t offset = 0;  ///< byte offset in the row

  bool operator==(const Column&) const = default;
};

struct Layout {
  std::string parameters_sha256;
  std::size_t row_bytes = 0;
  std::vector<Column> columns;  ///< the first is t_s

  bool operator==(const Layout&) const = default;
  /// Returns the column of this name, or null.
  const Column* find(std::string_view name) const;
};

/// The column's value in a row of `row_bytes`.
double value_in(std::string_view row, const Column& column);

/// Value of a bit-field column of one byte; 0 if there is no such column.
unsigned bits_in(std::string_view row, const Layout& layout, std::string_view name);

/// JSON of the header that begins at this offset; empty if none begins there or it is damaged.
std::optional<std::string_view> header_at(std::string_view bytes, std::size_t at);

/// Errors (input), as `FILE:/pointer`: another version, a duplicate column, a first column other
/// than t_s, a row size that differs from that of the columns.
Result<Layout> layout_of(std::string_view json, const std::string& file);

}  // namespace awmr::awl
