#include "agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace awmr {
namespace {

constexpr double kStopWatchError_s = 0.2;
constexpr double kAutomaticTiming_s = 1e-3;
constexpr double kCourseError = 0.005;
constexpr double kLargestRoundingShare = 0.05;

/// Decimal places of a number: 79.16 has 2, 1e-05 has 5. Only 12 significant digits count, because
/// a mapping that scales a column changes the digits after them by rounding.
int decimal_places(double value) {
  const std::string text = fmt::format("{:.11e}", value);  // d.ddddddddddde[+-]dd
  const std::size_t exponent_mark = text.find('e');
  const std::size_t last_digit = text.find_last_not_of('0', exponent_mark - 1);
  const std::size_t point = text.find('.');
  const int digits = last_digit > point ? static_cast<int>(last_digit - point) : 0;
  return std::max(0, digits - std::stoi(text.substr(exponent_mark + 1)));
}

}  // namespace

double last_place(const CsvTable& table, std::string_view column,
                  std::span<const ColumnMapping> mappings) {
  double scale = 1.0;
  double offset = 0.0;
  for (const std::size_t used : table.mapped) {
    const ColumnMapping& mapping = mappings[used];
    if (mapping.name != column) continue;
    scale = mapping.scale;
    offset = mapping.offset;
  }
  int places = 0;
  for (const double value : table.column(column)) {
    places = std::max(places, decimal_places((value - offset) / scale));
  }
  return std::abs(scale) * std::pow(10.0, -places);
}

double rounding_error(double printed, double last_place) {
  return std::min(0.5 * last_place, kLargestRoundingShare * std::abs(printed));
}

namespace {

bool is_automatic(double elapsed_last_place) {
  // The factor 1 + 1e-9 is needed because last_place() computes the place with pow(), which may
  // return 1.0000000000000002e-3 for 1e-3.
  return elapsed_last_place <= kAutomaticTiming_s * (1.0 + 1e-9);
}

}  // namespace

double timing_std_s(double elapsed_last_place) {
  return is_automatic(elapsed_last_place) ? elapsed_last_place / std::sqrt(12.0)
                                          : 0.5 * kStopWatchError_s;
}

double timing_error(double timed, double elapsed_s, double elapsed_last_place) {
  const double timing_s = is_automatic(elapsed_last_place) ? elapsed_last_place : kStopWatchError_s;
  return std::abs(timed) * (timing_s / elapsed_s + kCourseError);
}

}  // namespace awmr
