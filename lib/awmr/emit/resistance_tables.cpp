#include "resistance_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

#include "awmr/core/option_text.h"

namespace awmr {
namespace {

constexpr int kMaxMantissaBits = 7;
/// The first entry is at a speed of at least 2^-20 = 1e-6 m/s or rad/s.
constexpr int kLowestExponent = -20;
constexpr int kMaxLines = 1024;  ///< per table: 8 KiB of flash
constexpr int kSamplesPerCell = 64;

/// Returns the straight line through the points of the law at the speeds `from` and `to`. From 0,
/// the line begins at the origin, although a law with Coulomb friction does not.
ResistanceLine chord(const ResistanceLaw& law, double from, double to) {
  const double start = from > 0.0 ? law(from) : 0.0;
  const double slope = (law(to) - start) / (to - from);
  return {static_cast<float>(slope), static_cast<float>(start - slope * from) + 0.0F};
}

EmittedTable table_between(const ResistanceLaw& law, int lowest_exponent, int top_exponent,
                           int mantissa_bits) {
  EmittedTable table;
  table.mantissa_bits = static_cast<std::uint8_t>(mantissa_bits);
  const int per_octave = 1 << mantissa_bits;
  const int cells = (top_exponent - lowest_exponent) * per_octave;
  double from = 0.0;
  for (int i = 0; i <= cells; ++i) {
    const double to = std::ldexp(1.0 + static_cast<double>(i % per_octave) / per_octave,
                                 lowest_exponent + i / per_octave);
    table.lines.push_back(chord(law, from, to));
    from = to;
  }
  table.lowest_speed = std::ldexp(1.0, lowest_exponent);
  table.top_speed = std::ldexp(1.0, top_exponent);
  table.first =
      ResistanceTable::cell_of(static_cast<float>(table.lowest_speed), table.mantissa_bits);
  return table;
}

/// Largest errors of a table in a range of speeds, as EmittedTable::worst_error and
/// worst_relative_error.
struct TableErrors {
  double absolute = 0.0;
  double relative = 0.0;
};

/// Compares the table with the law at `samples` evenly spaced speeds in [lo, hi), and increases
/// `errors` to the largest differences. Skips speeds below `rest_speed`: there the controller does
/// not use the table, but a straight line (RestingTable).
void measure(const ResistanceLaw& law, double lo, double hi, int samples, double rest_speed,
             const EmittedTable& table, TableErrors& errors) {
  const ResistanceTable view = table.view();
  for (int i = 0; i < samples; ++i) {
    const auto speed = static_cast<float>(lo + (hi - lo) * i / samples);
    if (static_cast<double>(speed) < rest_speed) continue;
    const double exact = law(static_cast<double>(speed));
    const double error = std::abs(static_cast<double>(view(speed)) - exact);
    if (exact < table.split) {
      errors.absolute = std::max(errors.absolute, error);
    } else {
      errors.relative = std::max(errors.relative, error / exact);
    }
  }
}

/// Returns the errors of the table below its first cell. Each octave (factor of 2 in speed) gets
/// the same number of samples, because the law can be steepest at rest, where evenly spaced samples
/// would miss the largest error.
TableErrors measure_below(const ResistanceLaw& law, double rest_speed, const EmittedTable& table) {
  TableErrors errors;
  for (double hi = table.lowest_speed; hi > 1e-9; hi /= 2.0) {
    measure(law, hi / 2.0, hi, kSamplesPerCell, rest_speed, table, errors);
  }
  return errors;
}

}  // namespace

ResistanceTable EmittedTable::view() const {
  return {lines.data(), static_cast<std::uint16_t>(lines.size()), first, mantissa_bits};
}

double EmittedTable::largest_relative_error() const {
  return std::max(worst_error / split, worst_relative_error);
}

double table_top(const ResistanceLaw& law, double full_scale) {
  double top = 1.0;
  while (top < 64.0 && law(top) < 1.5 * full_scale) top *= 2.0;
  return top;
}

Result<EmittedTable> resistance_table(const std::string& name, const ResistanceLaw& law,
                                      double full_scale, double top,
                                      std::optional<double> error_share, double rest_speed) {
  const int top_exponent = std::ilogb(top);
  EmittedTable best;     // the smallest table within the bound
  EmittedTable closest;  // the table with the smallest error
  // Errors below the first cell, by the exponent of the speed at which this cell begins; they do
  // not depend on the number of mantissa bits.
  std::map<int, TableErrors> below;
  for (int bits = 0; bits <= kMaxMantissaBits; ++bits) {
    // Errors from the first cell on. Each pass of the inner loop adds the next lower octave.
    TableErrors from_first;
    for (int lowest = top_exponent - 1; lowest >= kLowestExponent; --lowest) {
      const int lines = (top_exponent - lowest) * (1 << bits) + 1;
      if (lines > kMaxLines) break;
      if (!best.lines.empty() && lines >= static_cast<int>(best.lines.size())) break;
      EmittedTable table = table_between(law, lowest, top_exponent, bits);
      table.split = 0.1 * full_scale;
      measure(law, table.lowest_speed, 2.0 * table.lowest_speed, kSamplesPerCell << bits,
              rest_speed, table, from_first);
      if (!below.contains(lowest)) below[lowest] = measure_below(law, rest_speed, table);
      table.worst_error = std::max(from_first.absolute, below[lowest].absolute);
      table.worst_relative_error = std::max(from_first.relative, below[lowest].relative);
      if (closest.lines.empty() ||
          table.largest_relative_error() < closest.largest_relative_error())
        closest = table;
      if (table.largest_relative_error() <= error_share.value_or(kTableError))
        best = std::move(table);
    }
  }
  if (!best.lines.empty()) return best;
  if (!error_share) return closest;
  return refusal(
      ErrorCode::kNoTable,
      fmt::format("the {} resistance has no table of at most {} entries with an error below "
                  "{}; the smallest error is {:.2g}: raise {}, or use {}",
                  name, kMaxLines, option_text(fmt::format("table-error {:g}", *error_share)),
                  closest.largest_relative_error(), option_text("table-error"),
                  option_text("resistance powf")));
}

}  // namespace awmr
