/// A stream in pieces of any size becomes the original log; damaged lines stay as comments.
#include "awmr/trials/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace awmr::recording_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kHeader = "t_s,force_left,force_right,note,speed_mps\n";
const std::string kRows = "0.0,0.1,0.1,go,0.0\n0.1,0.1,0.1,go,0.02\n0.2,0.1,0.1,stop 1,0.03\n";

Recording recorded(const std::string& bytes, std::size_t piece = 1U << 20U) {
  Recording recording;
  for (std::size_t i = 0; i < bytes.size(); i += piece) recording.add(bytes.substr(i, piece));
  recording.finish();
  return recording;
}

TEST(Recording, IsTheStreamWhateverItsPieces) {
  for (std::size_t piece = 1; piece < 40; ++piece) {
    const Recording recording = recorded("# a comment\n\n" + kHeader + kRows, piece);
    EXPECT_EQ(recording.text(), "# a comment\n\n" + kHeader + kRows);
    EXPECT_EQ(recording.rows(), 3U);
    EXPECT_THAT(recording.findings("a.csv"), IsEmpty());
  }
}

TEST(Recording, EndsLinesAsBoardsDo) {
  const std::string expected = kHeader + kRows;
  for (const std::string end : {"\r\n", "\r"}) {
    std::string bytes;
    for (const char c : expected) bytes += c == '\n' ? end : std::string(1, c);
    for (const std::size_t piece : {1U, 7U, 1000U}) {
      EXPECT_EQ(recorded(bytes, piece).text(), expected);
    }
  }
}

struct Damaged {
  std::string line;
  std::string why;
};

TEST(Recording, KeepsDamagedLinesAsCommentsAtTheirPlace) {
  const Damaged cases[] = {{"0.3,0.1,0.1", "it has 3 cells, but the header has 5"},
                           {"0.3,0.1,0.1,go,0.4,9,9", "it has 7 cells, but the header has 5"},
                           {"0.3,0.1,0.1,go,0.0x4", "its cell speed_mps is \"0.0x4\""},
                           {"0.3,0.1,0.1,g\x01o,0.4", "control characters"},
                           {std::string("0.3,0.1,0.1,g\0o,0.4", 19), "control characters"},
                           {kHeader.substr(0, kHeader.size() - 1), "the board may have restarted"},
                           {std::string(kMaxRecordedLine + 1, 'x'), "longer than"},
                           {"\"0.3,0.1,0.1,go,0.4", "it has 0 cells"}};
  for (const Damaged& damaged : cases) {
    SCOPED_TRACE(damaged.why);
    const Recording recording = recorded(kHeader + kRows + damaged.line + "\n0.4,0,0,go,0.1\n");
    EXPECT_EQ(recording.rows(), 4U);
    EXPECT_EQ(recording.set_aside(), 1U);
    EXPECT_EQ(std::count(recording.text().begin(), recording.text().end(), '\n'), 6);
    EXPECT_THAT(recording.text(), HasSubstr("\n# "));
    EXPECT_EQ(recording.text().find('\0'), std::string::npos);
    ASSERT_EQ(recording.findings("a.csv").size(), 1U);
    const Finding finding = recording.findings("a.csv").front();
    EXPECT_EQ(finding.line, 5);
    EXPECT_EQ(finding.code, "lines-set-aside");
    EXPECT_THAT(finding.message, HasSubstr(damaged.why));
    EXPECT_THAT(finding.message, HasSubstr("1 of 6 lines"));
  }
}

TEST(Recording, LeavesWordsInPlaceOfNumbersToTheReader) {
  const Recording recording = recorded(kHeader + kRows + "0.3,0.1,0.1,go,nan\n0.4,0.1,,go,0.1\n");
  EXPECT_EQ(recording.rows(), 5U);
  EXPECT_EQ(recording.set_aside(), 0U);
}

TEST(Recording, SetsAsideALineThatWasCut) {
  const Recording recording = recorded(kHeader + kRows + "0.3,0.1,0.1,go,0.1");
  EXPECT_EQ(recording.rows(), 3U);
  EXPECT_EQ(recording.text(), kHeader + kRows + "# 0.3,0.1,0.1,go,0.1\n");
  EXPECT_THAT(recording.findings("a").front().message, HasSubstr("ended within this line"));
}

TEST(Recording, FindsTheHeaderAfterTextOfTheBoard) {
  const Recording recording = recorded("3,0.1,go,0.02\nHello, I am ready\n" + kHeader + kRows);
  EXPECT_TRUE(recording.has_header());
  EXPECT_EQ(recording.text(), "# 3,0.1,go,0.02\n# Hello, I am ready\n" + kHeader + kRows);
  EXPECT_EQ(recording.rows(), 3U);
  EXPECT_THAT(recording.findings("a").front().message, HasSubstr("before the header"));
}

TEST(Recording, FindsAHeaderWithOtherNamesAndInAComment) {
  Recording mapped({{"speed_mps", "V", 1.0, 0.0}});
  mapped.add("time;V\n0,5;1\n1,5;2,5\n2x5;3\n");
  EXPECT_EQ(mapped.rows(), 2U);
  EXPECT_EQ(mapped.set_aside(), 1U);
  const Recording marked = recorded("# t_s, as it comes\n#t_s;speed_mps\n0;1\n1;2\n1\n");
  EXPECT_EQ(marked.rows(), 2U);
  EXPECT_EQ(marked.set_aside(), 1U);
}

TEST(Recording, LeavesAStreamWithoutAHeaderAsItIs) {
  const std::string other = "time,throttle\n0,1\n1,2,3\n";
  const Recording recording = recorded(other);
  EXPECT_FALSE(recording.has_header());
  EXPECT_EQ(recording.text(), other);
  EXPECT_EQ(recording.rows(), 0U);
}

TEST(Recording, StopsWhereItIsFull) {
  constexpr std::size_t kMax = 1000;
  Recording recording({}, kMax);
  recording.add(kHeader);
  for (int i = 0; i < 100; ++i) recording.add("0.0,0.1,0.1,go,0.0\n");
  recording.finish();
  EXPECT_TRUE(recording.full());
  EXPECT_LE(recording.text().size(), kMax + 1);
  EXPECT_TRUE(recording.text().ends_with("go,0.0\n"));
}

}  // namespace
}  // namespace awmr::recording_test
