/// On-board log: rows read, findings on lost and damaged data, and all kinds of invalid files.
#include "awmr/trials/awl.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "awl_text.h"
#include "awmr/emit/board/log_ring.h"
#include "awmr/trials/read_trials.h"
#include "trial_text.h"

namespace awmr::testing::awl_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> codes(const AwlLog& log) {
  std::vector<std::string> all;
  for (const Finding& finding : log.findings) all.push_back(finding.code);
  return all;
}

/// Checks that column 0 is the time in steps of 0.01 s.
std::vector<int> steps(const AwlLog& log) {
  std::vector<int> all;
  for (const double t_s : log.columns[0]) all.push_back(static_cast<int>(std::lround(100.0 * t_s)));
  return all;
}

std::vector<int> range(int from, int to) {
  std::vector<int> all;
  for (int i = from; i < to; ++i) all.push_back(i);
  return all;
}
std::vector<int> joined(std::vector<int> first, const std::vector<int>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(Awl, ReadsEveryRowAsItWas) {
  const auto log = read_awl(awl_log(20), "a.awl");
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_THAT(log->findings, IsEmpty());
  EXPECT_EQ(log->parameters_sha256, "abc");
  EXPECT_EQ(steps(*log), range(0, 20));
  EXPECT_EQ(log->runs, 1U);
  EXPECT_EQ(log->header.front(), "t_s");
  EXPECT_EQ(log->header.back(), "run");
  EXPECT_EQ(log->columns[2], std::vector<double>(20, 0.5));
  EXPECT_EQ(log->columns[1][3], static_cast<double>(0.25F + 0.03F));
}

TEST(Awl, ADamagedHeaderIsReplacedByItsCopy) {
  std::string bytes = awl_header(awl_json()) + awl_log(20);
  bytes[100] ^= 1;
  const auto log = read_awl(bytes, "a.awl");
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_EQ(steps(*log), range(0, 20));
  EXPECT_THAT(codes(*log), ElementsAre("log-damaged"));
  EXPECT_THAT(log->findings[0].message, HasSubstr("bytes 0 to 2047"));
}

TEST(Awl, RowsThatTheChipLostAreCounted) {
  const auto log = read_awl(awl_log(20) + awl_rows(44, 60), "a.awl");
  ASSERT_TRUE(log);
  EXPECT_EQ(steps(*log), joined(range(0, 20), range(44, 60)));
  EXPECT_EQ(log->lost, 24U);
  EXPECT_THAT(codes(*log), ElementsAre("rows-lost"));
  EXPECT_THAT(log->findings[0].message, HasSubstr("24 before 0.44 s (the chip had no room to"));
}

TEST(Awl, EveryDamagedByteCostsItsRowAndNoOther) {
  const std::string good = awl_log(30);
  for (std::size_t at = kLogHeaderBytes + 10 * 64; at < kLogHeaderBytes + 11 * 64; ++at) {
    for (const int bit : {0, 3, 7}) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      const auto log = read_awl(bytes, "a.awl");
      ASSERT_TRUE(log);
      ASSERT_EQ(steps(*log), joined(range(0, 10), range(11, 30))) << at << " bit " << bit;
      ASSERT_THAT(codes(*log), ElementsAre("rows-lost", "log-damaged"));
      ASSERT_THAT(log->findings[0].message, HasSubstr("1 before 0.11 s (the file is damaged"));
      ASSERT_THAT(log->findings[1].message, HasSubstr("64 bytes"));
    }
  }
}

TEST(Awl, FindsRowsAfterMissingOrAdditionalBytes) {
  const std::string good = awl_log(40);
  for (std::size_t gone = 1; gone < 130; gone += 3) {
    std::string bytes = good;
    bytes.erase(kLogHeaderBytes + 10 * 64 + 5, gone);
    const auto log = read_awl(bytes, "a.awl");
    ASSERT_TRUE(log);
    const int next = 10 + static_cast<int>((5 + gone + 63) / 64);
    EXPECT_EQ(steps(*log), joined(range(0, 10), range(next, 40))) << gone;
  }
  std::string more = good;
  more.insert(kLogHeaderBytes + 10 * 64,
              "\xB5\x62\xA7"
              "AWL\xB5");
  const auto log = read_awl(more, "a.awl");
  ASSERT_TRUE(log);
  EXPECT_EQ(steps(*log), range(0, 40));
  EXPECT_THAT(codes(*log), ElementsAre("log-damaged"));
}

TEST(Awl, ATruncatedTailIsKeptUpToItsLastWholeRow) {
  const std::string whole = awl_log(30);
  for (std::size_t size = kLogHeaderBytes + 10 * 64; size < whole.size(); size += 7) {
    const auto log = read_awl(whole.substr(0, size), "a.awl");
    ASSERT_TRUE(log) << size;
    const std::size_t rows = (size - kLogHeaderBytes) / 64;
    EXPECT_EQ(steps(*log), range(0, static_cast<int>(rows)));
    if ((size - kLogHeaderBytes) % 64 != 0) {
      EXPECT_THAT(codes(*log), ElementsAre("log-truncated"));
    }
  }
}

TEST(Awl, ARestartedChipBeginsANewRun) {
  LogRow row = awl_row(0);
  row.reset_cause = 8;
  std::string second;
  for (std::uint32_t i = 0; i < 12; ++i) {
    row = awl_row(i);
    row.reset_cause = 8;
    second += awl_bytes(row);
  }
  for (const std::string& between : {awl_header(awl_json()), std::string()}) {
    const auto log = read_awl(awl_log(20) + between + second, "a.awl");
    ASSERT_TRUE(log);
    EXPECT_EQ(log->runs, 2U);
    EXPECT_EQ(log->columns.back()[19], 1.0);
    EXPECT_EQ(log->columns.back()[20], 2.0);
    EXPECT_THAT(codes(*log), ElementsAre("chip-reset"));
    EXPECT_THAT(log->findings[0].message, HasSubstr("run 2 began with a reset by the watchdog"));
  }
}

TEST(Awl, RowsThatMeasureNothingAreSetAside) {
  std::string bytes = awl_header(awl_json());
  for (std::uint32_t i = 0; i < 40; ++i) {
    LogRow row = awl_row(i);
    if (i < 5) row.fault = 0x08;  // fault kFaultHeadingStale: no heading yet
    if (i == 20) row.u_mps = std::numeric_limits<float>::quiet_NaN();  // not a number
    if (i == 25) row.psi_rad = std::numeric_limits<float>::infinity();
    if (i == 30) row.fault = 0x20;  // kFaultCommandTimeout: the measurements are valid
    bytes += awl_bytes(row);
  }
  const auto log = read_awl(bytes, "a.awl");
  ASSERT_TRUE(log);
  EXPECT_EQ(log->rows(), 33U);
  EXPECT_THAT(codes(*log), ElementsAre("rows-not-measured"));
  EXPECT_THAT(log->findings[0].message, HasSubstr("7 rows are not used"));
}

TEST(Awl, ARunThatIsTooShortIsSetAsideAndAFileWithoutAnyRefused) {
  const auto log = read_awl(awl_log(9) + awl_log(20), "a.awl");
  ASSERT_TRUE(log);
  EXPECT_EQ(steps(*log), range(0, 20));
  EXPECT_EQ(log->runs, 1U);
  EXPECT_THAT(codes(*log), ElementsAre("short-run"));
  const auto none = read_awl(awl_log(9), "a.awl");
  ASSERT_FALSE(none);
  EXPECT_EQ(exit_code(none.error()), 1);
  EXPECT_EQ(exit_code(read_awl(awl_log(0), "a.awl").error()), 1);
}

TEST(Awl, RefusesMalformedHeaders) {
  const auto replaced = [](const std::string& what, const std::string& by) {
    std::string json = awl_json();
    json.replace(json.find(what), what.size(), by);
    return awl_header(json) + awl_rows(0, 20);
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "no undamaged header of an awmr log"},
      {awl_rows(0, 20), "no undamaged header"},
      {awl_header("{"), "a.awl:1"},
      {awl_header("[]"), "a.awl:"},
      {replaced("awl/1", "awl/2"), "awmr.awl/1"},
      {replaced(":64", ":63"), "the sync bytes, checksum, row number and columns have 64"},
      {replaced(":64", ":0"), "/row_bytes"},
      {replaced("\"t_s\"", "\"time\""), "must be t_s"},
      {replaced("\"x_m\"", "\"y_m\""), "another column"},
      {replaced("\"x_m\"", "\"run\""), "not 'run'"},
      {replaced("\"x_m\"", "\"x,m\""), "letters, digits and _"},
      {replaced("\"x_m\"", "\"=1\\n\""), "letters, digits and _"},
      {replaced("\"x_m\"", "\"\""), "expected 1 to"},
      {replaced("f32", "f64"), "f64"},
      {replaced("0.01", "0"), "/columns/0/scale"},
      {replaced("\"scale\":0.01", "\"scal\":0.01"), "scale"},
      {awl_log(20) + awl_header(awl_json("0.02")) + awl_rows(0, 20), "split the file there"}};
  for (const auto& [bytes, words] : cases) {
    const auto log = read_awl(bytes, "a.awl");
    ASSERT_FALSE(log) << words;
    EXPECT_EQ(exit_code(log.error()), 2) << words;
    EXPECT_THAT(to_text(log.error()), HasSubstr(words));
  }
}

TEST(Awl, HeadersWithoutEndAreRefusedQuickly) {
  std::string bytes = awl_log(20);
  for (int i = 0; i < 300'000; ++i)
    bytes +=
        "\xA7"
        "AWL";
  const auto log = read_awl(bytes, "a.awl");
  ASSERT_FALSE(log);
  EXPECT_THAT(to_text(log.error()), HasSubstr("damaged headers"));
}

TEST(Awl, IsReadAsALogByItselfAndAsItsCsv) {
  const std::string bytes = awl_log(60);
  const auto direct = accepted(read_log, bytes);
  const auto csv = accepted(read_log, log_csv(*read_awl(bytes, "a.awl")));
  EXPECT_EQ(direct.set.rows(), 61U);  // including the added row of rest before the first one
  EXPECT_EQ(direct.set.t_s, csv.set.t_s);
  EXPECT_EQ(direct.set.force_left, csv.set.force_left);
  EXPECT_EQ(direct.set[LogChannel::kSpeed]->value, csv.set[LogChannel::kSpeed]->value);
  EXPECT_EQ(direct.set[LogChannel::kHeading]->value, csv.set[LogChannel::kHeading]->value);
}

TEST(LogRing, KeepsRowsInOrderAndCountsThoseItHasNoRoomFor) {
  LogRing<2> ring;
  std::vector<std::uint32_t> taken;
  const auto put = [&] {
    if (LogRow* row = ring.begin_row()) {
      row->step = row->sequence;
      ring.end_row();
    }
  };
  const auto take = [&](bool rest) {
    const std::uint8_t count = ring.ready(rest);
    const LogRow* rows = ring.sealed(count);
    for (std::uint8_t i = 0; i < count; ++i) taken.push_back(rows[i].sequence);
    ring.release(count);
    return count;
  };
  for (int i = 0; i < 7; ++i) put();
  EXPECT_EQ(take(false), 0);  // no complete block yet
  put();
  EXPECT_EQ(take(false), 8);
  for (int i = 0; i < 20; ++i) put();  // more rows than the 16 that fit
  EXPECT_EQ(take(false), 8);
  EXPECT_EQ(take(false), 8);
  for (int i = 0; i < 3; ++i) put();
  EXPECT_EQ(take(true), 3);  // at the end of a file, also rows of an incomplete block
  for (int i = 0; i < 5; ++i) put();
  EXPECT_EQ(take(false), 5);  // a call returns rows up to the end of a block only
  for (int turn = 0; turn < 100; ++turn) {
    for (int i = 0; i < 8; ++i) put();
    EXPECT_EQ(take(false), 8);
  }
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 36 + 800; ++i) {
    if (i < 24 || i >= 28) expected.push_back(i);
  }
  EXPECT_EQ(taken, expected);
}

}  // namespace
}  // namespace awmr::testing::awl_test
