/// lib/awmr/validate/CLAIMS.md equals the program's output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/process.h"

namespace awmr::testing {
namespace {

TEST(ClaimsDocument, EqualsTheOutputOfTheProgram) {
  const TemporaryDirectory directory;
  const std::string out = directory.path().string();
  const std::string program = AWMR_PROGRAM;
  const auto identified = run_process(
      program +
          " identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
          "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
          out + "/model.json",
      AWMR_SOURCE_DIR);
  ASSERT_EQ(identified.exit_code, 0) << identified.err;
  const auto validated = run_process(program +
                                         " validate --model model.json --claims "
                                         "--claims-table claims.md -o validation.json",
                                     directory.path());
  ASSERT_EQ(validated.exit_code, 0) << validated.err;
  EXPECT_EQ(read_all(directory.path() / "claims.md"),
            read_all(std::string(AWMR_SOURCE_DIR) + "/lib/awmr/validate/CLAIMS.md"))
      << "make it again: awmr validate --model model.json --claims --claims-table "
         "lib/awmr/validate/CLAIMS.md -o validation.json";
  EXPECT_THAT(validated.out, ::testing::HasSubstr("10 of 14 claims reproduced"));
}

}  // namespace
}  // namespace awmr::testing
