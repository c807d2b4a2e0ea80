/// Every `awmr` example of the README runs.
#include <gmock/gmock.h>

#include <sstream>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::readme_test {
namespace {

/// Lines of the README's ```sh blocks that start with `awmr `.
std::vector<std::string> examples() {
  std::istringstream readme(read_all(std::string(AWMR_SOURCE_DIR) + "/README.md"));
  std::vector<std::string> lines;
  bool inside = false;
  for (std::string line; std::getline(readme, line);) {
    if (line.rfind("```", 0) == 0) inside = line == "```sh";
    if (inside && line.rfind("awmr ", 0) == 0) lines.push_back(line);
  }
  return lines;
}

TEST(Readme, EveryExampleRuns) {
  const TemporaryDirectory directory;
  // The examples read configs/ and datasets/ of the source and write below the current directory.
  for (const char* name : {"configs", "datasets"}) {
    std::filesystem::create_directory_symlink(std::filesystem::path(AWMR_SOURCE_DIR) / name,
                                              directory.path() / name);
  }
  const std::vector<std::string> lines = examples();
  ASSERT_GE(lines.size(), 7u) << "one example per command";
  for (const std::string& line : lines) {
    const ProcessResult result =
        run_process(AWMR_PROGRAM + line.substr(std::string("awmr").size()), directory.path());
    EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.err;
  }
}

/// Lines of a command's help that are examples.
std::vector<std::string> examples_of(const std::string& command) {
  std::istringstream help(awmr(command + " --help").out);
  std::vector<std::string> lines;
  for (std::string line; std::getline(help, line);) {
    if (line.starts_with("  awmr ")) lines.push_back(line.substr(2));
  }
  return lines;
}

TEST(Help, EveryExampleRunsWhereInitWroteTheirFiles) {
  const TemporaryDirectory directory;
  // Each command after those whose files it uses.
  for (const char* command :
       {"init",     "check",   "run",     "identify", "live",       "tune",   "validate",
        "simulate", "compare", "merge",   "emit",     "export",     "report", "suggest",
        "recover",  "map",     "compass", "schema",   "completion", "man"}) {
    const std::vector<std::string> lines = examples_of(command);
    EXPECT_FALSE(std::string(command) != "completion" && lines.empty()) << command;
    for (const std::string& line : lines) {
      const ProcessResult result =
          run_process(AWMR_PROGRAM + line.substr(4, line.find('|') - 4), directory.path());
      EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.err;
    }
  }
}

}  // namespace
}  // namespace awmr::testing::readme_test
