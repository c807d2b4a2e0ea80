/// Protection against data loss on writing and reading: outputs that are inputs, links, read-only
/// files, files that change meanwhile, killed programs.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "awmr/core/file.h"
#include "awmr/core/files/temporary_file.h"
#include "core/directory_test.h"
#include "core/faults.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

namespace fs = std::filesystem;

using FileLoss = DirectoryTest;

TEST_F(FileLoss, RefusesOutputEqualToInput) {
  ASSERT_TRUE(write_file(path("a.json"), "precious"));
  fs::create_symlink("a.json", path("link"));
  fs::create_symlink(".", path("here"));
  const std::vector<fs::path> inputs{path("other.json"), path("a.json")};
  for (const fs::path& output :
       {path("a.json"), path("link"), path("here/a.json"), path("here/here/link")}) {
    EXPECT_THAT(faults_of(check_output(output, inputs)),
                ElementsAre(AllOf(HasSubstr("it is the input"), HasSubstr("a.json"))))
        << output;
  }
  EXPECT_TRUE(check_output(path("b.json"), inputs));
  EXPECT_TRUE(check_output("/dev/null", std::vector<fs::path>{"/dev/null"}));
}

TEST_F(FileLoss, RefusesToReplaceAReadOnlyFile) {
  ASSERT_TRUE(write_file(path("a.json"), "precious"));
  ASSERT_EQ(::chmod(path("a.json").c_str(), 0444), 0);
  EXPECT_THAT(faults_of(check_output(path("a.json"))), ElementsAre(HasSubstr("read-only")));
  EXPECT_THAT(faults_of(write_file(path("a.json"), "new")), ElementsAre(HasSubstr("read-only")));
  EXPECT_EQ(read_file(path("a.json")).value(), "precious");
  EXPECT_THAT(names(), ElementsAre("a.json"));
}

TEST_F(FileLoss, RefusesToReplaceAHardLink) {
  ASSERT_TRUE(write_file(path("a.json"), "precious"));
  fs::create_hard_link(path("a.json"), path("b.json"));
  EXPECT_THAT(faults_of(check_output(path("b.json"))), ElementsAre(HasSubstr("hard link")));
  EXPECT_THAT(faults_of(write_file(path("b.json"), "new")), ElementsAre(HasSubstr("hard link")));
  EXPECT_EQ(read_file(path("a.json")).value(), "precious");
}

TEST_F(FileLoss, WritesTheTargetOfADanglingLink) {
  ASSERT_TRUE(make_directory(path("d")));
  fs::create_symlink("d/a.json", path("first"));
  fs::create_symlink("first", path("second"));
  ASSERT_TRUE(write_file(path("second"), "new"));
  EXPECT_TRUE(fs::is_symlink(path("second")));
  EXPECT_TRUE(fs::is_symlink(path("first")));
  EXPECT_EQ(read_file(path("d/a.json")).value(), "new");
}

TEST_F(FileLoss, LinksInACircleAreAnError) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_FALSE(write_file(path("a"), "new"));
  EXPECT_FALSE(check_output(path("a")));
  EXPECT_TRUE(fs::is_symlink(path("a")));
}

TEST_F(FileLoss, WritesAFileWithANameOf255Bytes) {
  const std::string longest(255, 'n');
  ASSERT_TRUE(write_file(path(longest), "x"));
  EXPECT_EQ(read_file(path(longest)).value(), "x");
  EXPECT_FALSE(check_output(path(longest + "n")));
  EXPECT_THAT(faults_of(write_file(path(longest + "n"), "x")), ElementsAre(HasSubstr("too long")));
}

TEST_F(FileLoss, AMissingDirectoryIsFoundBeforeTheWork) {
  EXPECT_THAT(faults_of(check_output(path("no/a.json"))), ElementsAre(HasSubstr("No such file")));
  EXPECT_THAT(faults_of(check_output(directory_.path())), ElementsAre(HasSubstr("directory")));
}

/// Returns the ID of a process that has ended.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST_F(FileLoss, RemovesTemporaryFilesOfAKilledProgram) {
  const std::string stale = ".awmr-" + std::to_string(ended_process()) + "-abcdef";
  const std::string alive = ".awmr-" + std::to_string(::getpid()) + "-abcdef";
  const std::string other = ".awmr-1-settings.json";
  for (const std::string& name : {stale, alive, other}) std::ofstream(path(name)) << "x";
  ASSERT_TRUE(write_file(path("a.json"), "x"));
  EXPECT_THAT(names(), UnorderedElementsAre("a.json", alive, other));
}

TEST_F(FileLoss, AKilledWriterLeavesTheOldFileAndTheNextOneTidiesUp) {
  ASSERT_TRUE(write_file(path("a.json"), "old"));
  const std::string large(200'000'000, 'x');
  const pid_t child = ::fork();
  if (child == 0) {
    (void)write_file(path("a.json"), large);
    ::_exit(0);
  }
  while (names().size() == 1) std::this_thread::yield();
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  const auto size = read_file(path("a.json")).value().size();
  EXPECT_TRUE(size == 3 || size == large.size());
  ASSERT_TRUE(write_file(path("b.json"), "y"));
  EXPECT_THAT(names(), UnorderedElementsAre("a.json", "b.json"));
}

TEST_F(FileLoss, WritesAllFilesOfASetOrNone) {
  ASSERT_TRUE(write_file(path("a.csv"), "old"));
  ASSERT_TRUE(make_directory(path("b.json")));  // cannot be written
  const std::vector<OutputFile> set{{path("a.csv"), "new"}, {path("b.json"), "new"}};
  EXPECT_FALSE(write_files(set));
  EXPECT_EQ(read_file(path("a.csv")).value(), "old");
  EXPECT_THAT(names(), UnorderedElementsAre("a.csv", "b.json"));
  fs::remove(path("b.json"));
  ASSERT_TRUE(write_files(set));
  EXPECT_EQ(read_file(path("a.csv")).value(), "new");
  EXPECT_EQ(read_file(path("b.json")).value(), "new");
}

TEST_F(FileLoss, ReportsAFileThatShrinksWhileRead) {
  constexpr std::size_t kBytes = 300'000'000;
  for (int i = 0; i < 5; ++i) {
    std::ofstream(path("a.csv")) << "x";
    fs::resize_file(path("a.csv"), kBytes);
    std::thread shrinking([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(10 * i));
      fs::resize_file(path("a.csv"), 1);
    });
    const auto bytes = read_file(path("a.csv"));
    shrinking.join();
    if (bytes) {
      EXPECT_TRUE(bytes->size() == kBytes || bytes->size() == 1);
    } else {
      EXPECT_THAT(faults_of(bytes), ElementsAre(HasSubstr("became shorter")));
    }
  }
}

TEST_F(FileLoss, AnEndlessInputIsRefused) {
  EXPECT_THAT(faults_of(read_file("/dev/zero", 1 << 20U)),
              ElementsAre(HasSubstr("longer than 1 MiB")));
}

TEST_F(FileLoss, AFullDeviceIsAnError) {
  EXPECT_THAT(faults_of(write_file("/dev/full", "x")), ElementsAre(HasSubstr("No space left")));
}

/// Starts a program that only creates temporary files 200 times, and ends it at random times.
TEST_F(FileLoss, ASignalLeavesNoTemporaryFileWhereverItComes) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      remove_temporaries_on_signals();
      write_all(path("started"), "");
      for (;;) (void)TemporaryFile::in(path("."));
    }
    while (!fs::exists(path("started"))) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 1000));
    ::kill(child, SIGTERM);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
    EXPECT_THAT(names(), ElementsAre("started")) << i;
    fs::remove(path("started"));
  }
}

}  // namespace
}  // namespace awmr::testing
