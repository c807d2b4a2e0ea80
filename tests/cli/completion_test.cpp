/// Completions of the command line in bash, zsh and fish; manual pages as read by groff and mandoc.
#include <gmock/gmock.h>

#include <string>

#include "cli/program.h"

namespace awmr::testing::completion_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Bash's completions of the last word, one per line. Bash splits "--mode=x" into three words.
std::string in_bash(const std::string& words) {
  const ProcessResult run = run_process(
      "bash -c 'source <(" + std::string(AWMR_PROGRAM) + " completion bash); COMP_WORDS=(" + words +
          "); COMP_CWORD=$((${#COMP_WORDS[@]}-1)); _awmr; printf \"%s\\n\" \"${COMPREPLY[@]}\"'",
      AWMR_SOURCE_DIR);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return "\n" + run.out;
}

TEST(Completion, OfBashKnowsCommandsOptionsChoicesAndFiles) {
  EXPECT_EQ(in_bash("awmr ident"), "\nidentify\n");
  EXPECT_EQ(in_bash("awmr simulate --mode \"\""), "\ndifferential\nsteering\ncombined\n");
  EXPECT_EQ(in_bash("awmr simulate --mode = st"), "\nsteering\n");
  EXPECT_EQ(in_bash("awmr tune --nom"), "\n--nominal\n");
  EXPECT_THAT(in_bash("awmr tune --config configs/paper/p"),
              HasSubstr("configs/paper/project.json"));
  EXPECT_EQ(in_bash("awmr run configs/syn"), "\nconfigs/synthetic\n");
  EXPECT_THAT(in_bash("awmr report \"\""),
              AllOf(HasSubstr("\nlib\n"), Not(HasSubstr("README.md"))));
  EXPECT_EQ(in_bash("awmr tune --draws \"\""), "\n\n");
}

/// Fish's completions of the line.
std::string in_fish(const std::string& line) {
  const ProcessResult run =
      run_process("export HOME=$(mktemp -d); fish --no-config -c '" + std::string(AWMR_PROGRAM) +
                      " completion fish | source; complete -C \"" + line + "\"'; rm -rf \"$HOME\"",
                  AWMR_SOURCE_DIR);
  EXPECT_THAT(run.err, IsEmpty());
  return "\n" + run.out;
}

TEST(Completion, OfFishKnowsCommandsOptionsChoicesAndFiles) {
  EXPECT_THAT(in_fish("awmr ident"), HasSubstr("\nidentify\t"));
  EXPECT_THAT(in_fish("awmr simulate --mode "),
              AllOf(HasSubstr("\ncombined"), HasSubstr("\nsteering")));
  EXPECT_THAT(in_fish("awmr tune --nom"), HasSubstr("\n--nominal\t"));
  EXPECT_THAT(in_fish("awmr tune --config configs/paper/p"),
              HasSubstr("configs/paper/project.json"));
  EXPECT_THAT(in_fish("awmr report configs/p"), HasSubstr("configs/paper/"));
}

/// True if a tab completes the line to `whole` in zsh, run in its own terminal.
bool zsh_completes(const std::string& line, const std::string& whole) {
  const TemporaryDirectory directory;
  const std::string here = directory.path().string();
  run_process(std::string(AWMR_PROGRAM) + " completion zsh > " + here + "/_awmr");
  write_all(directory.path() / "ask.zsh",
            "zmodload zsh/zpty\n"
            "zpty z 'cd " AWMR_SOURCE_DIR
            "; exec zsh -f -i'\n"
            "zpty -w z 'fpath=(" +
                here + " $fpath); autoload -Uz compinit; compinit -u -d " + here +
                "/dump; echo rea\"\"dy'\n"
                "zpty -r z out '*ready*'\n"
                "zpty -w -n z $'" +
                line +
                "\\t'\n"
                "zpty -r z out '*" +
                whole +
                "*'\n"
                "zpty -d z\n");
  return run_process("HOME=" + here + " timeout 60 zsh -f " + here + "/ask.zsh").exit_code == 0;
}

TEST(Completion, OfZshKnowsCommandsOptionsChoicesAndFiles) {
  EXPECT_TRUE(zsh_completes("awmr ident", "identify"));
  EXPECT_TRUE(zsh_completes("awmr simulate --mode ste", "steering"));
  EXPECT_TRUE(zsh_completes("awmr tune --nom", "--nominal"));
  EXPECT_TRUE(zsh_completes("awmr tune --config configs/paper/p", "project.json"));
}

TEST(Completion, OfAnotherShellIsRefused) {
  const ProcessResult run = awmr("completion tcsh");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("bash, zsh, fish"));
}

TEST(ManualPage, OfEveryCommandIsReadWithoutAWarning) {
  const TemporaryDirectory directory;
  ASSERT_EQ(awmr("man -o " + directory.path().string()).exit_code, 0);
  int pages = 0;
  for (const auto& page : std::filesystem::directory_iterator(directory.path())) {
    ++pages;
    const ProcessResult groff =
        run_process("groff -man -ww -z -Tutf8 '" + page.path().string() + "'");
    EXPECT_EQ(groff.out + groff.err, "");
    // The pages have no date, so that equal sources give equal bytes.
    const ProcessResult mandoc = run_process("mandoc -T lint -W warning '" + page.path().string() +
                                             "' | grep -v 'missing date'");
    EXPECT_EQ(mandoc.out + mandoc.err, "");
  }
  EXPECT_GE(pages, 19);
}

TEST(ManualPage, HasTheOptionsOfTheHelp) {
  const ProcessResult page = awmr("man simulate");
  EXPECT_THAT(page.out, HasSubstr(".TH AWMR\\-SIMULATE 1"));
  EXPECT_THAT(page.out, HasSubstr("One of: differential, steering, combined. Required."));
  EXPECT_THAT(awmr("man").out, HasSubstr("\\fBawmr\\-identify\\fR(1)"));
  EXPECT_THAT(awmr("man simulat").err, HasSubstr("did you mean 'simulate'?"));
}

}  // namespace
}  // namespace awmr::testing::completion_test
