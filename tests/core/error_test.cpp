#include <gmock/gmock.h>

#include "awmr/core/result.h"

namespace awmr::testing {
namespace {

Error error_of(const tl::unexpected<Error>& unexpected) { return unexpected.value(); }

TEST(Error, EachKindHasItsExitCode) {
  EXPECT_EQ(exit_code(error_of(refusal("no"))), 1);
  EXPECT_EQ(exit_code(error_of(input_error("a.csv:3:7", "bad"))), 2);
  EXPECT_EQ(exit_code(error_of(program_fault("oh"))), 3);
}

TEST(Error, IsPrintedAsCompilersDo) {
  EXPECT_EQ(to_text(error_of(input_error("a.csv:3:7", "bad"))), "error: a.csv:3:7: bad\n");
  EXPECT_EQ(to_text(error_of(refusal("no"))), "error: no\n");
}

TEST(Error, ShowsTwentyFaultsAndCountsTheRest) {
  std::vector<Fault> faults(20, {"a", "b"});
  EXPECT_THAT(to_text(error_of(input_errors(faults))), ::testing::EndsWith("error: a: b\n"));
  faults.push_back({"a", "last"});
  const std::string text = to_text(error_of(input_errors(faults)));
  EXPECT_THAT(text, ::testing::EndsWith("error: 1 more fault is not shown\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 21);
}

}  // namespace
}  // namespace awmr::testing
