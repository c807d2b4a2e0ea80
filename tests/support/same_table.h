/// Comparison of two tables: bits of the numbers, rows, places, notes.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>

#include "awmr/core/csv.h"

namespace awmr::testing {

/// First difference between two columns; empty if they are equal.
inline std::string difference_of_columns(const CsvTable& a, const CsvTable& b,
                                         const std::string& name) {
  if (a.has(name) != b.has(name)) return name + " is in one of them";
  if (!a.has(name)) return {};
  if (a.present(name) != b.present(name)) return name + " is present in other rows";
  if (a.column(name).size() != b.column(name).size()) return name + " has other rows";
  for (std::size_t row = 0; row < a.rows(); ++row) {
    const auto bits = [&](const CsvTable& table) {
      return std::bit_cast<std::uint64_t>(table.column(name)[row]);
    };
    if (bits(a) != bits(b)) return name + " in row " + std::to_string(row);
  }
  return {};
}

inline std::string difference_of_notes(const CsvTable& a, const CsvTable& b) {
  if (a.notes().size() != b.notes().size()) return "the number of notes";
  for (std::size_t i = 0; i < a.notes().size(); ++i) {
    const CsvNote& one = a.notes()[i];
    const CsvNote& other = b.notes()[i];
    if (one.line != other.line || one.code != other.code || one.message != other.message) {
      return "the note " + one.message;
    }
  }
  return {};
}

/// First difference between the tables; empty if they are equal. Places are compared only in every
/// `step`th row, because finding them takes long in a long file.
inline std::string difference(const CsvTable& a, const CsvTable& b,
                              std::span<const CsvColumn> columns, std::size_t step = 1) {
  if (a.rows() != b.rows()) return "the number of rows";
  if (a.header_place() != b.header_place()) return "the header's place";
  if (a.mapped() != b.mapped()) return "the mappings";
  if (std::bit_cast<std::uint64_t>(a.clock_s()) != std::bit_cast<std::uint64_t>(b.clock_s())) {
    return "the clock";
  }
  for (const CsvColumn& column : columns) {
    if (std::string found = difference_of_columns(a, b, column.name); !found.empty()) return found;
  }
  for (std::size_t row = 0; row < a.rows(); ++row) {
    if (a.line(row) != b.line(row)) return "the line of row " + std::to_string(row);
    if (row % step != 0) continue;
    for (const CsvColumn& column : columns) {
      const std::string place = a.place(row, column.name);
      if (place != b.place(row, column.name)) return place + ", " + b.place(row, column.name);
    }
  }
  return difference_of_notes(a, b);
}

}  // namespace awmr::testing
