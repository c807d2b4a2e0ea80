/// Tests of the functions that make text from a user's file safe for display.
#include "awmr/core/text.h"

#include <gmock/gmock.h>

#include "awmr/core/result.h"

namespace awmr::testing {
namespace {

TEST(Printable, LeavesUtf8AsItIs) {
  const std::string text = "Ackermann, \xC3\xBC \xE2\x82\xAC \xF0\x9F\x9A\x99 \\ 'x'";
  EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesControlCharactersOfNames) {
  EXPECT_EQ(printable("a\x1B[2Jb\r\n\t\x7F"), "a\\x1b[2Jb\\r\\n\\t\\x7f");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\u{9b}31m");  // terminal control code
  EXPECT_EQ(printable("\xE2\x80\xAE"
                      "txt"),
            "\\u{202e}txt");  // right-to-left override
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

TEST(Printable, BytesThatAreNoUtf8AreEscaped) {
  EXPECT_EQ(printable("a\xFFz"), "a\\xffz");
  EXPECT_EQ(printable("\xC3"), "\\xc3");
  EXPECT_EQ(printable("\xC0\x80"), "\\xc0\\x80");           // overlong encoding
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Printable, LinesStayLinesWhereRequested) {
  EXPECT_EQ(printable_lines("a\n\x1Bz\n"), "a\n\\x1bz\n");
}

TEST(Shortened, KeepsTheBeginningAndTheEnd) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefg", 6), "abcd ... fg");
  EXPECT_EQ(shortened("\xC3\xBC\xC3\xBC\xC3\xBC\xC3\xBC", 5), "\xC3\xBC\xC3\xBC ... ");
}

TEST(ErrorText, ShortensLongCellsInMessages) {
  const Error error{
      ErrorKind::kInput,
      {{ErrorCode::kMissing, std::string(100000, 'p'), std::string(10'000'000, 'm')}}};
  EXPECT_LT(to_text(error).size(), 2200U);
}

TEST(ErrorText, EscapesALineBreakInAName) {
  EXPECT_EQ(to_text(Error{ErrorKind::kInput, {{ErrorCode::kMissing, "a\nb", "no \"\x1B[31m\""}}}),
            "error: a\\nb: no \"\\x1b[31m\" [missing]\n");
}

}  // namespace
}  // namespace awmr::testing
