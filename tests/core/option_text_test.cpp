#include "awmr/core/option_text.h"

#include <gtest/gtest.h>

namespace awmr::testing {
namespace {

TEST(OptionText, IsSpeltAsTheCallerSpellsOptions) {
  const std::string message = "use " + option_text("loss huber") + ", or " + option_text("joint");
  EXPECT_EQ(spell_options(message, "--"), "use --loss huber, or --joint");
  EXPECT_EQ(spell_options(option_text("break_even") + " " + option_text("column t_s=a_b"), "--"),
            "--break-even --column t_s=a_b");
  EXPECT_EQ(spell_options(message, ""), "use loss huber, or joint");
}

TEST(OptionText, AnErrorIsPlainForALibrarysUserAndSpeltForACommands) {
  const Error error{ErrorKind::kInput,
                    {{ErrorCode::kMissing, option_text("method"), "use " + option_text("log")}}};
  EXPECT_EQ(to_text(error), "error: method: use log [missing]\n");
  EXPECT_EQ(to_text(error, "--"), "error: --method: use --log [missing]\n");
}

TEST(OptionText, LeavesOtherBracesAlone) {
  EXPECT_EQ(spell_options("{} {a} {option:", ""), "{} {a} {option:");
  EXPECT_EQ(spell_options("", ""), "");
}

}  // namespace
}  // namespace awmr::testing
