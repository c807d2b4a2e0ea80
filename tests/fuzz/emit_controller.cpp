/// Writes the emitted library of the paper's robot for the target control_step: `emit_controller
/// DIR`.
#include <filesystem>

#include "awmr/core/file.h"
#include "emit/paper_robot.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto files = awmr::firmware_library(awmr::testing::paper_robot(), awmr::kPaperGains,
                                            awmr::testing::paper_inputs(), {});
  if (!files) return 1;
  for (const awmr::EmittedFile& file : *files) {
    const std::filesystem::path path = std::filesystem::path(argv[1]) / file.path;
    if (!awmr::make_directory(path.parent_path())) return 1;
    if (!awmr::write_file(path, file.bytes)) return 1;
  }
  return 0;
}
