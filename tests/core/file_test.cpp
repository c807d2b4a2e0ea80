/// Files are written completely or not at all.
#include "awmr/core/file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "core/directory_test.h"
#include "core/faults.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace fs = std::filesystem;

using FileTest = DirectoryTest;

/// During its lifetime, writing beyond `bytes` bytes of a file fails, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(FileTest, WritesAndReadsAnyBytes) {
  std::string bytes;
  for (int i = 0; i < 300000; ++i) bytes += static_cast<char>(i % 256);
  ASSERT_TRUE(write_file(path("a.bin"), bytes));
  EXPECT_EQ(read_file(path("a.bin")).value(), bytes);
  EXPECT_THAT(names(), ElementsAre("a.bin"));
}

TEST_F(FileTest, AnEmptyFileIsEmpty) {
  ASSERT_TRUE(write_file(path("a.txt"), ""));
  EXPECT_THAT(read_file(path("a.txt")).value(), IsEmpty());
}

TEST_F(FileTest, AFailingWriteLeavesTheOldFileAndNothingElse) {
  ASSERT_TRUE(write_file(path("a.txt"), "precious"));
  const std::string large(100000, 'x');
  {
    const FileSizeLimit limit(1000);
    const auto written = write_file(path("a.txt"), large);
    EXPECT_THAT(faults_of(written),
                ElementsAre(HasSubstr("cannot write the file: File too large")));
    EXPECT_FALSE(write_file(path("new.txt"), large));
  }
  EXPECT_EQ(read_file(path("a.txt")).value(), "precious");
  EXPECT_THAT(names(), ElementsAre("a.txt"));
}

TEST_F(FileTest, MissingDirectoryAndDirectoryAsFileAreFaults) {
  const auto missing = write_file(path("no") / "a.txt", "x");
  EXPECT_THAT(faults_of(missing), ElementsAre(HasSubstr("No such file or directory")));
  ASSERT_TRUE(make_directory(path("d")));
  EXPECT_THAT(faults_of(write_file(path("d"), "x")), ElementsAre(HasSubstr("is a directory")));
  EXPECT_THAT(faults_of(read_file(path("d"))), ElementsAre(HasSubstr("is a directory")));
  EXPECT_THAT(faults_of(read_file(path("a.txt"))), ElementsAre(HasSubstr("No such file")));
  EXPECT_THAT(names(), ElementsAre("d"));
}

TEST_F(FileTest, KeepsTheModeOfTheOldFileAndGivesANewOneTheUsual) {
  const mode_t mask = ::umask(022);
  ::umask(mask);
  ASSERT_TRUE(write_file(path("a.txt"), "x"));
  struct stat status {};
  ASSERT_EQ(::stat(path("a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0666U & ~mask);
  ASSERT_EQ(::chmod(path("a.txt").c_str(), 0600), 0);
  ASSERT_TRUE(write_file(path("a.txt"), "y"));
  ASSERT_EQ(::stat(path("a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(FileTest, ReplacesWhatASymbolicLinkPointsTo) {
  ASSERT_TRUE(write_file(path("a.txt"), "x"));
  fs::create_symlink("a.txt", path("link"));
  ASSERT_TRUE(write_file(path("link"), "y"));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_file(path("a.txt")).value(), "y");
}

TEST_F(FileTest, WritesToAndReadsFromAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const std::string bytes(200000, 'p');  // more than a pipe holds
  std::thread writer([&] { EXPECT_TRUE(write_file(path("pipe"), bytes)); });
  EXPECT_EQ(read_file(path("pipe")).value(), bytes);
  writer.join();
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(FileTest, AReaderNeverSeesPartOfAFile) {
  const std::string old_bytes(50000, 'a');
  const std::string new_bytes(70000, 'b');
  ASSERT_TRUE(write_file(path("a.txt"), old_bytes));
  std::thread writer([&] {
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(write_file(path("a.txt"), i % 2 == 0 ? new_bytes : old_bytes));
    }
  });
  for (int i = 0; i < 200; ++i) {
    const std::string bytes = read_file(path("a.txt")).value();
    EXPECT_TRUE(bytes == old_bytes || bytes == new_bytes);
  }
  writer.join();
}

TEST_F(FileTest, MakesADirectoryWithItsParents) {
  ASSERT_TRUE(make_directory(path("a") / "b" / "c"));
  ASSERT_TRUE(make_directory(path("a") / "b" / "c"));
  EXPECT_TRUE(fs::is_directory(path("a") / "b" / "c"));
  ASSERT_TRUE(write_file(path("f"), "x"));
  EXPECT_FALSE(make_directory(path("f") / "d"));
}

TEST_F(FileTest, AnOutputThatItsReaderRefusesIsAFaultAndLeavesTheOldFile) {
  ASSERT_TRUE(write_file(path("a.txt"), "precious"));
  const ReadBack refuse = [](std::string_view bytes, const std::string& file) -> Status {
    if (bytes == "good") return {};
    return input_error(ErrorCode::kWrongType, file + ":/key", "expected a number, found null");
  };
  const auto refused = write_file(path("a.txt"), "bad", refuse);
  ASSERT_FALSE(refused);
  EXPECT_EQ(exit_code(refused.error()), 3);
  EXPECT_THAT(faults_of(refused),
              ElementsAre(AllOf(HasSubstr("a.txt was not written"), HasSubstr("a.txt:/key"),
                                HasSubstr("expected a number"), HasSubstr("unchanged"))));
  const OutputFile both[] = {{path("b.txt"), "good", refuse}, {path("a.txt"), "bad", refuse}};
  EXPECT_FALSE(write_files(both));
  EXPECT_EQ(read_file(path("a.txt")).value(), "precious");
  EXPECT_THAT(names(), ElementsAre("a.txt"));
  ASSERT_TRUE(write_file(path("a.txt"), "good", refuse));
  EXPECT_EQ(read_file(path("a.txt")).value(), "good");
}

TEST_F(FileTest, APipeWithoutAProgramAtItsOtherEndIsAFaultAfterAWhile) {
  ASSERT_EQ(::mkfifo(path("a.pipe").c_str(), 0600), 0);
  EXPECT_THAT(faults_of(read_file(path("a.pipe"))),
              ElementsAre(HasSubstr("no program writes to this pipe after 5 s")));
  EXPECT_THAT(faults_of(write_file(path("a.pipe"), "x")),
              ElementsAre(HasSubstr("no program reads this pipe after 5 s")));
}

TEST_F(FileTest, APipeWaitsForItsWriterAndReader) {
  ASSERT_EQ(::mkfifo(path("a.pipe").c_str(), 0600), 0);
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_TRUE(write_file(path("a.pipe"), "slow"));
  });
  EXPECT_EQ(read_file(path("a.pipe")).value(), "slow");
  writer.join();
}

TEST_F(FileTest, QueriesReportExistenceAndLookUpErrors) {
  ASSERT_TRUE(write_file(path("a.txt"), ""));
  ASSERT_EQ(::mkfifo(path("a.pipe").c_str(), 0600), 0);
  fs::create_symlink("a.loop", path("a.loop"));
  const fs::path long_name = path(std::string(256, 'n'));
  EXPECT_TRUE(regular_file_exists(path("a.txt")).value());
  EXPECT_FALSE(regular_file_exists(path("a.none")).value());
  EXPECT_FALSE(path_exists(path("a.txt") / "below").value());
  EXPECT_TRUE(directory_exists(path("")).value());
  EXPECT_THAT(faults_of(regular_file_exists(path("a.pipe"))), ElementsAre(HasSubstr("is a pipe")));
  EXPECT_THAT(faults_of(regular_file_exists(path(""))), ElementsAre(HasSubstr("is a directory")));
  for (const fs::path& bad : {path("a.loop"), long_name}) {
    EXPECT_THAT(faults_of(path_exists(bad)), ElementsAre(HasSubstr("cannot look up this path")));
    EXPECT_FALSE(directory_exists(bad));
    EXPECT_FALSE(regular_file_exists(bad));
    EXPECT_FALSE(list_directory(bad));
    EXPECT_FALSE(check_output_directory(bad));
    EXPECT_FALSE(check_output(bad));
    EXPECT_FALSE(make_directory(bad));
  }
  EXPECT_TRUE(check_output_directory(path("new") / "newer"));
  EXPECT_FALSE(make_directory(path("new") / std::string(256, 'n')));
  EXPECT_FALSE(path_exists(path("new")).value()) << "no directory may be created";
  EXPECT_THAT(faults_of(check_output_directory(path("a.txt"))),
              ElementsAre(HasSubstr("this is a file, but a directory is needed")));
  EXPECT_THAT(list_directory(path("")).value(),
              ElementsAre(path("a.loop"), path("a.pipe"), path("a.txt")));
}

}  // namespace
}  // namespace awmr::testing
