/// Written numbers and tables read back the same; no input crashes the reader.
#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <optional>

#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_cell.h"
#include "core/any_finite.h"
#include "core/csv_text.h"

namespace awmr::testing {
namespace {

RC_GTEST_PROP(FormatNumber, ReadsBackTheSameBits, ()) {
  const double value = *any_finite();
  const auto back = number_from_text(format_number(value));
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::bit_cast<std::uint64_t>(*back) == std::bit_cast<std::uint64_t>(value));
}

RC_GTEST_PROP(FormatNumber, NoShorterTextReadsBackTheSame, ()) {
  const double value = *any_finite();
  const std::string text = format_number(value);
  // Rounding to n digits gives the nearest number with n digits: if it does not read back the same,
  // no other does.
  for (int digits = 1; digits <= 17; ++digits) {
    for (const auto form : {std::chars_format::scientific, std::chars_format::general}) {
      char other[64];
      const int precision = form == std::chars_format::scientific ? digits - 1 : digits;
      const char* end = std::to_chars(other, other + sizeof(other), value, form, precision).ptr;
      const std::string_view shorter(other, static_cast<std::size_t>(end - other));
      const auto back = number_from_text(shorter);
      RC_ASSERT(!back.has_value() || *back != value || shorter.size() >= text.size());
    }
  }
}

/// Reads a table of one cell and returns its number; none if the cell is refused.
std::optional<double> number_in_table(const std::string& cell) {
  const auto table = read_csv_text("x,y\n0," + cell + "\n", "a.csv", std::vector<CsvColumn>{{"y"}});
  return table ? std::optional(table->column("y")[0]) : std::nullopt;
}

/// Decimal numbers of all lengths are read with the same bits as by std::from_chars.
RC_GTEST_PROP(CsvNumber, IsThatOfFromChars, ()) {
  const auto digits = *rc::gen::container<std::string>(rc::gen::inRange('0', ':'));
  std::string text = *rc::gen::element<std::string>("", "-", "00") + digits;
  text.insert(text.size() - *rc::gen::inRange<std::size_t>(0, digits.size() + 1),
              *rc::gen::element<std::string>("", "."));
  text += *rc::gen::element<std::string>("", "", "", "e-3", "E+12");
  double expected = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), expected);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  const auto value = number_in_table(text);
  RC_ASSERT(value.has_value() == is_number);
  if (!is_number) return;
  RC_ASSERT(std::bit_cast<std::uint64_t>(*value) == std::bit_cast<std::uint64_t>(expected));
}

TEST(CsvNumber, OfFifteenAndMoreDigitsIsThatOfFromChars) {
  for (const std::string text :
       {"-0", "-0.0", "00.500", ".5", "5.", "999999999999999", "9999999999999999",
        "-.999999999999999", "9007199254740993", "9007199254740993.0", "9007199254740992",
        "900719925474099.3", "1844674407370955161", "18446744073709551616",
        "0.1000000000000000055511151231257827", "123456789.012345", "123456789.0123456",
        "0.000000000000001", "0.0000000000000001"}) {
    double expected = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), expected);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(number_in_table(text).value()),
              std::bit_cast<std::uint64_t>(expected))
        << text;
  }
  for (const std::string text : {"", "-", ".", "-.", "--1", "1..2", "1-2", "1.2.3"}) {
    EXPECT_FALSE(number_in_table(text).has_value()) << text;
  }
}

TEST(FormatNumber, WritesTheShortestForm) {
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(-2.0), "-2");
  EXPECT_EQ(format_number(1e300), "1e+300");
  EXPECT_EQ(format_number(0.0), "0");
}

RC_GTEST_PROP(Csv, ATableThatIsWrittenReadsBackTheSame, ()) {
  const auto columns = *rc::gen::inRange<std::size_t>(1, 5);
  const auto rows = *rc::gen::inRange<std::size_t>(1, 20);
  const char delimiter = *rc::gen::element(',', ';', '\t');
  const std::string end = *rc::gen::element<std::string>("\n", "\r\n", "\r", "\n# c,o;m\n", "\n\n");
  const auto values = *rc::gen::container<std::vector<double>>(columns * rows, any_finite());
  const bool is_quoted = *rc::gen::arbitrary<bool>();
  const std::string quote = is_quoted ? "\"" : "";
  std::vector<CsvColumn> requested;
  std::string text;
  for (std::size_t c = 0; c < columns; ++c) {
    requested.push_back({"column " + std::to_string(c)});
    text += (c == 0 ? "" : std::string(1, delimiter)) + quote + requested.back().name + quote;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i % columns == 0 ? end : std::string(1, delimiter)) + quote +
            format_number(values[i]) + quote;
  }
  const auto table = read_text(text, requested);
  RC_ASSERT(table.has_value());
  RC_ASSERT(table->rows() == rows);
  for (std::size_t i = 0; i < values.size(); ++i) {
    RC_ASSERT(table->column(requested[i % columns].name)[i / columns] == values[i]);
  }
}

RC_GTEST_PROP(Csv, NoBytesBreakTheReader, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
      "x", "1", ",", ";", "\t", "\n", "\r", "\"", "\"\"", "#", " ", "+", "-", ".", "e", "nan", "0x",
      "\xC3\xBC", "\xFF", "\xEF\xBB\xBF", std::string(1, '\0')));
  std::string text = *rc::gen::element<std::string>("", "x\n", "x,y\n");
  for (const std::string& piece : pieces) text += piece;
  const auto table = read_text(text, {{"x"}, {"y", false}});
  if (!table) {
    RC_ASSERT(!table.error().faults.empty());
    RC_ASSERT(table.error().kind == ErrorKind::kInput);
    return;
  }
  RC_ASSERT(table->rows() > 0);
  RC_ASSERT(table->column("x").size() == table->rows());
  for (const double value : table->column("x")) RC_ASSERT(std::isfinite(value));
}

RC_GTEST_PROP(CsvText, AnyTextReadsBackFromItsCell, (const std::vector<std::string>& texts)) {
  RC_PRE(!texts.empty());
  std::string line = cell_of_text(texts[0]);
  for (std::size_t i = 1; i < texts.size(); ++i) line.append(",").append(cell_of_text(texts[i]));
  line += "\nnext";
  std::string_view rest = line;
  RC_ASSERT(take_text_record(rest) == texts);
  RC_ASSERT(rest == "next");
}

TEST(CsvText, NoCellBeginsAsAFormula) {
  for (const std::string begin : {"=", "+", "-", "@", "\t", "\r"}) {
    const std::string cell = cell_of_text(begin + "1+1");
    EXPECT_EQ(cell.substr(cell[0] == '"' ? 1 : 0, 1), "'") << cell;
  }
  EXPECT_EQ(cell_of_text("c3, a heading"), "\"c3, a heading\"");
  EXPECT_EQ(cell_of_text("c3 = a heading"), "c3 = a heading");
}

}  // namespace
}  // namespace awmr::testing
