/// Terminal output: few findings; colours and progress on a terminal only.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "cli/program.h"

namespace awmr::testing::terminal_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Terminal : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  std::string identify() const {
    return "identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
           "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv -o " +
           path("model.json");
  }
  /// Runs the program in a pseudo-terminal. Returns stdout and stderr combined.
  static std::string on_terminal(const std::string& environment, const std::string& arguments) {
    return run_process("TERM=xterm " + environment + " script -qec '" + AWMR_PROGRAM + " " +
                           arguments + "' /dev/null",
                       AWMR_SOURCE_DIR)
        .out;
  }

  /// Runs the program in a pseudo-terminal until it prints text that matches `pattern` (grep), then
  /// ends it. Returns that line, or nothing if the program ends without it.
  std::string first_on_terminal(const std::string& pattern, const std::string& arguments) const {
    return run_process("{ TERM=xterm script -qec '" + std::string(AWMR_PROGRAM) + " " + arguments +
                           "' /dev/null & echo $! > " + path("pid") +
                           "; wait; } | stdbuf -o0 tr '\\r' '\\n' | { grep -a -m 1 '" + pattern +
                           "'; kill -KILL $(cat " + path("pid") + ") 2>/dev/null; }",
                       AWMR_SOURCE_DIR)
        .out;
  }

  const TemporaryDirectory directory_;
};

std::ptrdiff_t lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

TEST_F(Terminal, ShowsTheWorstFindingsAndCountsTheRest) {
  const ProcessResult few = awmr(identify());
  EXPECT_EQ(lines_of(few.err), 4) << few.err;
  EXPECT_THAT(few.err, AllOf(HasSubstr("[fragile-mass]"), HasSubstr("more (--verbose): "),
                             HasSubstr(" tau-turn-mismatch"), HasSubstr("1 single-stop-time")));
  const ProcessResult all = awmr(identify() + " --verbose");
  EXPECT_GT(lines_of(all.err), 10);
  EXPECT_THAT(all.out, HasSubstr("estimators side by side"));
  EXPECT_LE(lines_of(few.out), 22) << "one screen";
  EXPECT_EQ(awmr(identify() + " --quiet").err, "");
}

TEST_F(Terminal, HasColoursByDefault) {
  const char* const coloured = "\033[1;33mwarning:\033[0m";
  EXPECT_THAT(on_terminal("", identify()), HasSubstr(coloured));
  EXPECT_THAT(on_terminal("NO_COLOR=1", identify()), Not(HasSubstr("\033[1")));
  EXPECT_THAT(on_terminal("TERM=dumb", identify()), Not(HasSubstr("\033")));
  EXPECT_THAT(awmr(identify()).err, Not(HasSubstr("\033")));
}

TEST_F(Terminal, NamesTheCommandThatExplainsFindings) {
  const char* const hint = "awmr explain CODE";
  EXPECT_THAT(on_terminal("", identify()), HasSubstr(hint));
  EXPECT_THAT(on_terminal("", identify() + " --quiet"), Not(HasSubstr(hint)));
  EXPECT_THAT(on_terminal("", "schema"), Not(HasSubstr(hint))) << "there is no finding";
  EXPECT_THAT(awmr(identify()).err, Not(HasSubstr(hint)));
}

TEST(Explain, PrintsSeverityMeaningAndRemedyOfACode) {
  const ProcessResult one = awmr("explain few-samples");
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(one.out, AllOf(HasSubstr("few-samples\n  severity warning\n"),
                             HasSubstr("meaning  fewer than 6 samples"),
                             HasSubstr("remedy   give --samples")));
  // Two codes of the same table row can have different severities.
  EXPECT_THAT(awmr("explain held-samples").out, HasSubstr("severity note\n"));
  EXPECT_THAT(awmr("explain quantised-samples").out, HasSubstr("severity warning\n"));
  const std::string all = awmr("explain").out;
  EXPECT_THAT(all, AllOf(HasSubstr("few-samples"), HasSubstr("inertia-mismatch"),
                         HasSubstr("Fits of logs\n")));
  EXPECT_THAT(awmr("explain few-samples --json").out, HasSubstr("\"severity\": \"warning\""));
  const ProcessResult none = awmr("explain few-sample");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("did you mean 'few-samples'?"));
  EXPECT_THAT(awmr("explain unsettle").err, HasSubstr("did you mean 'unsettled'"));
}

TEST_F(Terminal, ShowsHowFarLongWorkIs) {
  ASSERT_EQ(awmr(identify()).exit_code, 0);
  const std::string tune = "tune --model " + path("model.json") + " -o " + path("gains.json");
  EXPECT_NE(first_on_terminal("searching for gains \\[.* left", tune), "");
  EXPECT_THAT(on_terminal("", tune + " --nominal --quiet"), Not(HasSubstr("searching")));
  // All families for two logs on one thread: takes seconds even on a fast processor.
  EXPECT_NE(first_on_terminal(" \\.\\.\\. 1 s of about .* at most",
                              "identify --vehicle configs/paper/vehicle.json --log "
                              "datasets/synthetic/drive_1.csv --log datasets/synthetic/drive_2.csv "
                              "--family auto --threads 1 -o " +
                                  path("driven.json")),
            "");
  EXPECT_THAT(awmr(tune + " --nominal").err, Not(HasSubstr("searching")));
}

}  // namespace
}  // namespace awmr::testing::terminal_test
