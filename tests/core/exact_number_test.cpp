/// Every number read equals that of std::from_chars, bit for bit.
#include <gmock/gmock.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "awmr/core/csv_blocks.h"
#include "awmr/core/exact_number.h"

namespace awmr::testing {
namespace {

using Random = std::mt19937_64;

std::size_t below(std::size_t end, Random& random) { return random() % end; }

std::string random_digits(std::size_t count, Random& random) {
  std::string digits;
  for (std::size_t i = 0; i < count; ++i) digits += static_cast<char>('0' + below(10, random));
  return digits;
}

/// Digits with a point anywhere, leading zeros, many digits.
std::string random_decimal(Random& random) {
  std::string text = below(2, random) == 0 ? "-" : "";
  if (below(4, random) == 0) text += std::string(below(25, random), '0');
  text += random_digits(below(22, random), random);
  if (below(4, random) != 0) {
    text += '.';
    if (below(4, random) == 0) text += std::string(below(25, random), '0');
    text += random_digits(below(22, random), random);
  }
  if (below(4, random) == 0) {
    const char* const marks[] = {"e", "E", "e+", "e-", "E-0", "e00"};
    text += marks[below(6, random)] + std::to_string(below(330, random));
  }
  return text;
}

/// Printed doubles of all magnitudes, and midpoints between two of them.
std::string random_double(Random& random) {
  const auto value = std::bit_cast<double>(random());
  if (!std::isfinite(value)) return "0";
  char text[900];
  const int precisions[] = {0, 5, 14, 15, 16, 17, 18, 40, 770};
  char* const end = below(3, random) == 0
                        ? std::to_chars(text, text + sizeof(text), value).ptr
                        : std::to_chars(text, text + sizeof(text), value,
                                        std::chars_format::scientific, precisions[below(9, random)])
                              .ptr;
  return {static_cast<const char*>(text), static_cast<const char*>(end)};
}

/// A logged number: few digits, a fixed number of decimals.
std::string random_measurement(Random& random) {
  char text[400];
  const double value = static_cast<double>(static_cast<std::int64_t>(random())) *
                       std::pow(10.0, -10 - static_cast<int>(below(12, random)));
  char* const end = std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed,
                                  static_cast<int>(below(13, random)))
                        .ptr;
  return {static_cast<const char*>(text), static_cast<const char*>(end)};
}

std::string random_number(Random& random) {
  switch (below(3, random)) {
    case 0:
      return random_decimal(random);
    case 1:
      return random_double(random);
    default:
      return random_measurement(random);
  }
}

/// Converts a text that as a whole is a number in range.
std::optional<double> from_chars(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

TEST(ExactNumber, IsThatOfFromCharsOrIsLeftToIt) {
  Random random(1);
  int exact = 0;
  for (int i = 0; i < 3'000'000; ++i) {
    const std::string text = random_number(random);
    const std::string padded = text + ",12345678";
    double value = 0.0;
    const char* const end = take_exact_number(padded.data(), value);
    if (end == nullptr) continue;
    const auto size = static_cast<std::size_t>(end - padded.data());
    const auto expected = from_chars(text.substr(0, size));
    ASSERT_TRUE(expected.has_value()) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(*expected)) << text;
    if (size == text.size()) ++exact;
  }
  EXPECT_GT(exact, 500'000);
}

TEST(ExactNumber, IsNoneWhereThereIsNone) {
  for (const std::string text : {"", "-", ".", "-.", "+1", "--1", "nan", "inf", "e5", " 1"}) {
    double value = 0.0;
    EXPECT_EQ(take_exact_number((text + ",12345678").data(), value), nullptr) << text;
  }
}

/// Values that the reader returns for a column of these cells.
std::vector<double> values_of(const std::vector<std::string>& cells, int threads) {
  std::string text = "x\n";
  for (const std::string& cell : cells) text += cell + "\n";
  const CsvColumn columns[] = {{"x"}};
  const auto table = read_csv_blocks(std::make_shared<const InputBytes>("a.csv", std::move(text)),
                                     columns, {}, {.bytes = 1000, .threads = threads})
                         .value();
  if (!table) return {};
  const std::span<const double> values = table->column("x");
  return {values.begin(), values.end()};
}

TEST(CsvBlocks, EveryNumberIsThatOfFromChars) {
  Random random(2);
  std::vector<std::string> cells{"0",
                                 "-0",
                                 "-0.0",
                                 "00.500",
                                 ".5",
                                 "5.",
                                 "1e22",
                                 "1e23",
                                 "9007199254740991",
                                 "9007199254740992",
                                 "9007199254740993",
                                 "9007199254740993.0",
                                 "4.9406564584124654e-324",
                                 "2.2250738585072011e-308",
                                 "2.2250738585072014e-308",
                                 "1.7976931348623157e308",
                                 "0.1e-6",
                                 "8.5e-7",
                                 "123456789012345678901234567890",
                                 "0.000000000000000000000000001",
                                 "0e999",
                                 "179769313486231580793728971405301e276",
                                 "6.92949564460091e-310"};
  std::vector<double> expected;
  for (const std::string& cell : cells) expected.push_back(from_chars(cell).value());
  while (cells.size() < 1'000'000) {
    const std::string cell = random_number(random);
    const auto value = from_chars(cell);
    if (!value) continue;
    cells.push_back(cell);
    expected.push_back(*value);
  }
  for (const int threads : {1, 3}) {
    const std::vector<double> values = values_of(cells, threads);
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(values[i]), std::bit_cast<std::uint64_t>(expected[i]))
          << cells[i];
    }
  }
}

}  // namespace
}  // namespace awmr::testing
