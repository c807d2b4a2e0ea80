/// Starts of programs by an argument list: arguments that arrive, output, exit codes, signals.
#include "awmr/core/files/process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "support/process.h"

namespace awmr::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ProgramEnd run(const std::string& program, std::vector<std::string> arguments,
               double time_limit_s = 20.0) {
  const auto end = run_program({.program = program,
                                .arguments = std::move(arguments),
                                .directory = "/",
                                .environment = {"A=b"},
                                .time_limit_s = time_limit_s});
  EXPECT_TRUE(end.has_value());
  return end.value_or(ProgramEnd{});
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Process, ArgumentsArriveAsTheyAreWhateverAShellWouldMakeOfThem) {
  const std::string hostile = "x'; touch HACKED; echo '$(id) `id` * \"\n";
  const ProgramEnd end = run("/usr/bin/printf", {"%s", hostile});
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_EQ(end.output, hostile);
}

TEST(Process, HasItsExitCodeItsDirectoryAndNoOtherEnvironment) {
  EXPECT_EQ(run("/bin/sh", {"-c", "exit 7"}).exit_code, 7);
  EXPECT_EQ(run("/bin/sh", {"-c", "kill -9 $$"}).exit_code, -1);
  EXPECT_EQ(run("/usr/bin/env", {}).output, "A=b\n");
  EXPECT_EQ(run("/bin/pwd", {}).output, "/\n");
  EXPECT_EQ(run("/bin/cat", {}).output, "");  // stdin is empty
}

TEST(Process, PastItsTimeLimitItEndsWithAllThatItStarted) {
  const auto start = std::chrono::steady_clock::now();
  const ProgramEnd end = run("/bin/sh", {"-c", "sleep 30 & echo $!; sleep 30"}, 0.3);
  EXPECT_TRUE(end.timed_out);
  EXPECT_EQ(end.exit_code, -1);
  EXPECT_LT(seconds_since(start), 10.0);
  const pid_t grandchild = std::atoi(end.output.c_str());
  ASSERT_GT(grandchild, 0);
  // Dead, or a zombie not yet reaped by its new parent; a signal takes time.
  const auto is_over = [grandchild] {
    const std::string status = read_all("/proc/" + std::to_string(grandchild) + "/stat");
    return ::kill(grandchild, 0) != 0 || status.find(") Z") != std::string::npos;
  };
  while (!is_over() && seconds_since(start) < 10.0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(is_over());
}

TEST(Process, DoesNotWaitForChildrenOfTheProgram) {
  const auto start = std::chrono::steady_clock::now();
  const ProgramEnd end = run("/bin/sh", {"-c", "sleep 30 & exit 3"});
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_LT(seconds_since(start), 10.0);
}

TEST(Process, LimitsTheOutputOfAProgram) {
  const ProgramEnd end = run("/usr/bin/yes", {}, 0.3);
  EXPECT_TRUE(end.timed_out);
  EXPECT_EQ(end.output.size(), 65536u);
}

TEST(Process, WhatCannotBeStartedIsAnError) {
  const auto end = run_program(
      {.program = "/no/such/program", .arguments = {}, .directory = "/", .environment = {}});
  ASSERT_FALSE(end.has_value());
  EXPECT_EQ(exit_code(end.error()), 2);
}

TEST(Process, DoesNotSearchProgramsInTheWorkingDirectory) {
  const TemporaryDirectory here;
  const std::string old = std::getenv("PATH");
  ::setenv("PATH", (".::" + here.path().filename().string() + ":/usr/bin:/bin").c_str(), 1);
  const auto found = find_program("sh");
  const auto missing = find_program("no-such-program-anywhere");
  ::setenv("PATH", old.c_str(), 1);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->is_absolute());
  EXPECT_FALSE(missing.has_value());
}

TEST(Process, PlainEnvironmentOmitsCompilerVariables) {
  ::setenv("CPATH", "/elsewhere", 1);
  ::setenv("GCC_EXEC_PREFIX", "/elsewhere/", 1);
  const std::vector<std::string> environment = plain_environment("/private");
  ::unsetenv("CPATH");
  ::unsetenv("GCC_EXEC_PREFIX");
  EXPECT_THAT(environment, Contains("TMPDIR=/private"));
  EXPECT_THAT(environment, Contains(StartsWith("PATH=")));
  for (const std::string& variable : environment)
    EXPECT_THAT(variable, Not(HasSubstr("elsewhere")));
}

}  // namespace
}  // namespace awmr::testing
