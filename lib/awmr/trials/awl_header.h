/// Parses the header of an `.awl` file, which defines the columns of its rows. Private to this
/// folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/result.h"

namespace awmr::awl {

/// Number type of a column.
enum class Kind { kFloat, kUnsigned, kByte };
inline constexpr NameTable<Kind, 3> kKindNames{
    {{"f32", Kind::kFloat}, {"u32", Kind::kUnsigned}, {"u8", Kind::kByte}}};

struct Column {
  std::string name;
  Kind kind = Kind::kFloat;
  double scale = 1.0;      ///< physical value of the column = stored number times this
  std::size_t offset = 0;  ///< byte offset in the row

  bool operator==(const Column&) const = default;
};

/// Layout of the rows of a file.
struct Layout {
  std::string parameters_sha256;  ///< SHA-256 of the model and gains in the firmware
  std::size_t row_bytes = 0;
  std::vector<Column> columns;  ///< columns in the order of the row; the first is t_s

  bool operator==(const Layout&) const = default;
  /// Returns the column of this name, or null.
  const Column* find(std::string_view name) const;
};

/// Returns the scaled value of a column. Precondition: `row` has Layout::row_bytes bytes.
double value_in(std::string_view row, const Column& column);

/// Returns the stored byte of the one-byte column `name`, without applying the scale. Used for
/// columns of bits, such as `fault`. 0 if the layout has no such column.
unsigned bits_in(std::string_view row, const Layout& layout, std::string_view name);

/// Returns the JSON text of the header that begins at the offset `at`; empty if no header begins
/// there or if its checksum is wrong.
std::optional<std::string_view> header_at(std::string_view bytes, std::size_t at);

/// Parses the JSON text of a header. Errors (input), with the place as `FILE:/pointer`: text that
/// is not JSON; an unknown version; a column with an invalid or duplicate name, or an invalid type
/// or scale; a first column other than t_s; a row size that differs from the sum of its parts.
Result<Layout> layout_of(std::string_view json, const std::string& file);

}  // namespace awmr::awl
