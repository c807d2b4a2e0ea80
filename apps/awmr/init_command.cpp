#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>
#include <system_error>

#include "awmr/core/file.h"
#include "awmr/model/vehicle_file.h"
#include "commands.h"
#include "embedded_files.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

struct InitCommand {
  fs::path directory;
  bool example = false;
  Drive drive = Drive::kFourWheel;
};

/// True if a template line belongs into a project with this drive. A line that begins with
/// "@four_wheel " is for that drive only, a line with "@steered " for drives with steering.
bool is_for(std::string_view mark, Drive drive) {
  if (mark == "steered") return drive != Drive::kDifferential;
  return mark == name_in(kDriveNames, drive);
}

/// Returns the lines of a template that apply to this drive.
std::string for_drive(std::string_view text, Drive drive) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (line.front() == '@') {
      const std::size_t space = line.find(' ');
      if (!is_for(line.substr(1, space - 1), drive)) continue;
      line.remove_prefix(space + 1);
    }
    lines += line;
  }
  return lines;
}

/// Returns the files of the new project. Errors (input): a file already exists (one error for
/// each), or its path cannot be looked up.
Result<std::vector<OutputFile>> files_to_write(const InitCommand& command) {
  std::vector<OutputFile> files;
  std::vector<Fault> faults;
  for (const EmbeddedFile& file : command.example ? example_files() : project_templates()) {
    const fs::path path = command.directory / file.path;
    std::error_code error;
    const fs::file_type type = fs::symlink_status(path, error).type();
    if (type == fs::file_type::none) {
      return input_error(
          ErrorCode::kCannotRead, path.string(),
          "cannot look up this path: " + error.message() + "; give another directory");
    }
    if (type != fs::file_type::not_found) {
      faults.push_back({ErrorCode::kWouldOverwrite, path.string(),
                        "already exists; choose another directory, or move it away"});
    }
    files.push_back(
        {path, command.example ? std::string(file.bytes) : for_drive(file.bytes, command.drive)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return files;
}

/// Returns the directories of the files that do not exist yet, each parent before its children.
Result<std::vector<fs::path>> new_directories(const std::vector<OutputFile>& files) {
  std::set<fs::path> found;
  for (const OutputFile& file : files) {
    for (fs::path path = file.path.parent_path(); !path.empty(); path = path.parent_path()) {
      AWMR_ASSIGN_OR_RETURN(const bool exists, path_exists(path));
      if (exists) break;
      found.insert(path);
    }
  }
  return std::vector<fs::path>(found.begin(), found.end());
}

/// Writes all files or none. If writing fails, removes the directories that it created.
Status write_all(const std::vector<OutputFile>& files) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> made, new_directories(files));
  Status written;
  for (const fs::path& directory : made) {
    if (written) written = make_directory(directory);
  }
  if (written) written = write_files(files);
  if (written) return written;
  // Errors are ignored: remove() leaves a directory that is not empty or was not created.
  std::error_code ignored;
  // Clang 14 cannot compile std::views::reverse of GCC 12's library.
  for (auto directory = made.rbegin(); directory != made.rend(); ++directory) {
    fs::remove(*directory, ignored);
  }
  return written;
}

std::string example_summary(const InitCommand& command, const std::vector<OutputFile>& files) {
  const bool here = command.directory == ".";
  return fmt::format(
      "wrote {} files to {} and {}: the paper's vehicle, its tables, scenarios, synthetic drives\n"
      "next: {}awmr run configs/paper/project.json -o out\n",
      files.size(), (command.directory / "configs").string(),
      (command.directory / "datasets").string(),
      here ? "" : fmt::format("cd {} && ", command.directory.string()));
}

std::string summary_of(const InitCommand& command, const std::vector<OutputFile>& files) {
  if (command.example) return example_summary(command, files);
  std::string text = "wrote\n";
  for (const OutputFile& file : files) text += fmt::format("  {}\n", file.path.string());
  return text +
         fmt::format(
             "next: fill in the nulls of vehicle.json ({} describes how to measure them), print\n"
             "field_sheet.html, record the trials; `awmr check {}` lists what is missing\n",
             (command.directory / "README.md").string(), command.directory.string());
}

Result<Outcome> execute(const InitCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<OutputFile> files, files_to_write(command));
  AWMR_RETURN_IF_ERROR(write_all(files));
  Outcome outcome{.summary = summary_of(command, files)};
  for (const OutputFile& file : files) outcome.written.push_back(file.path);
  return outcome;
}

}  // namespace

void add_init(CLI::App& app, Session& session) {
  auto command = std::make_shared<InitCommand>();
  CLI::App* sub = add_command(
      app, session, "init",
      "Start with your own robot: a project to fill in, a field sheet to print",
      "awmr init my_rover\n  awmr init --example .", [command] { return execute(*command); });
  add_directory(*sub, "DIR", command->directory,
                "Directory for the project; nothing in it is overwritten")
      ->required();
  auto* drive = add_choice(
      *sub, "--drive", command->drive, kDriveNames,
      "four_wheel (default): four driven wheels, steered in front; "
      "differential: without steering; front_wheel: only the front wheels are driven, and steered");
  drive->transform(CLI::Validator(
      [](const std::string& name) { return name == kRearWheelDrive ? kNoRearWheelDrive : ""; },
      ""));
  sub->add_flag("--example", command->example,
                "Instead of a project, write the files that the examples in the help of the "
                "commands use: the paper's vehicle, its tables, scenarios, synthetic drives")
      ->excludes(drive);
}

}  // namespace awmr::cli
