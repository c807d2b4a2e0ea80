#include <gmock/gmock.h>

#include "awmr/core/result.h"

namespace awmr::testing {
namespace {

Error error_of(const tl::unexpected<Error>& unexpected) { return unexpected.value(); }

TEST(Error, EachKindHasItsExitCode) {
  EXPECT_EQ(exit_code(error_of(refusal(ErrorCode::kNoGains, "no"))), 1);
  EXPECT_EQ(exit_code(error_of(input_error(ErrorCode::kOutOfRange, "a.csv:3:7", "bad"))), 2);
  EXPECT_EQ(exit_code(error_of(program_fault("oh"))), 3);
}

TEST(Error, IsPrintedAsCompilersDo) {
  EXPECT_EQ(to_text(error_of(input_error(ErrorCode::kOutOfRange, "a.csv:3:7", "bad"))),
            "error: a.csv:3:7: bad [out-of-range]\n");
  EXPECT_EQ(to_text(error_of(refusal(ErrorCode::kNoGains, "no"))), "error: no [no-gains]\n");
}

TEST(Error, ShowsTwentyFaultsAndCountsTheRest) {
  std::vector<Fault> faults;
  for (char c = 'a'; c < 'a' + 20; ++c)
    faults.push_back({ErrorCode::kMissing, "a", std::string(1, c)});
  EXPECT_THAT(to_text(error_of(input_errors(faults))),
              ::testing::EndsWith("error: a: t [missing]\n"));
  faults.push_back({ErrorCode::kMissing, "a", "last"});
  const std::string text = to_text(error_of(input_errors(faults)));
  EXPECT_THAT(text, ::testing::EndsWith("error: 1 more fault is not shown [more-faults]\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 21);
}

TEST(Error, FaultsOfOneCauseInOneFileAreShownOnce) {
  std::vector<Fault> faults;
  for (int i = 1; i <= 5; ++i)
    faults.push_back({ErrorCode::kMissing, "a.csv:" + std::to_string(i) + ":3", "found \"x\""});
  faults.push_back({ErrorCode::kMissing, "b.csv:1:3", "found \"y\""});
  const std::string text = to_text(error_of(input_errors(faults)));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
  EXPECT_THAT(text, ::testing::HasSubstr("; 4 more faults"));
}

TEST(Error, TheSameFaultOfOtherKeysIsShownEach) {
  std::vector<Fault> faults;
  for (const char* key : {"/a", "/b", "/c", "/d"}) {
    faults.push_back({ErrorCode::kMissing, std::string("v.json:") + key, "this key is missing"});
  }
  const std::string text = to_text(error_of(input_errors(faults)));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
}

}  // namespace
}  // namespace awmr::testing
