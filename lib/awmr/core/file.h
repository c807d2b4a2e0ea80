/// Files: input read whole and within a bound, output that appears whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// The most that is read of one file or pipe: 1 GiB, ten million rows of a log.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U;

/// Errors: the file is missing, a directory, unreadable, longer than `max_bytes`, no longer what it
/// was when it was opened (another program writes it), or a pipe that no program opens to write for
/// kPipeWait_s.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::size_t max_bytes = kMaxFileBytes);

/// Reads an output's bytes as the command that takes the file does; `file` names it in errors.
using ReadBack = std::function<Status(std::string_view bytes, const std::string& file)>;

/// Writes beside `path`, flushes and renames, so that a reader sees the old file or the new one,
/// never part of either. A pipe or a terminal is written to as it is. Makes no directory. A symbolic
/// link stays and what it names is written, also where that is not there yet. What a killed program
/// left in the directory (`.awmr-PID-XXXXXX`) goes away.
/// Errors: as check_output; the disk is full; (fault) `read_back` refuses the bytes, and the old file
/// stays.
Status write_file(const std::filesystem::path& path, std::string_view bytes,
                  const ReadBack& read_back = {});

struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
  ReadBack read_back = {};  ///< empty: no program reads this file
};

/// Files that belong together: all are written under temporary names, then renamed one after the
/// other. Where one cannot be written, or is a pipe or a device, none is. A program killed between two renamings (some
/// microseconds) leaves files of both sets: let the last one hold the hash of the others.
Status write_files(std::span<const OutputFile> files);

/// Whether `path` can be written without loss, to be asked before long work begins.
/// Errors: one of `inputs` by this or another name; a directory; a read-only file; a file with a
/// second name (hard link), which would keep the old bytes; its directory is missing or read-only.
Status check_output(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> inputs = {});

/// Makes `path` and its parents where they are missing. Errors: as check_output_directory.
Status make_directory(const std::filesystem::path& path);

/// Seconds that an opened pipe waits for the program at its other end.
inline constexpr double kPipeWait_s = 5.0;

/// Queries of the file system, symbolic links followed. False: nothing has this name. Errors (input):
/// the name cannot be looked up (a directory that may not be searched, links that form a loop, a
/// name that is too long).
Result<bool> path_exists(const std::filesystem::path& path);
Result<bool> directory_exists(const std::filesystem::path& path);
/// For files that are found by their name in a directory. Errors (input): as above; something else
/// has the name (a pipe, a device, a directory).
Result<bool> regular_file_exists(const std::filesystem::path& path);
/// The same errors; a missing file is left to its reader.
Status check_regular_file(const std::filesystem::path& path);
/// Whether files can be made in `path`, or `path` itself where it is missing. Errors (input): the
/// directory, or the nearest one above it that exists, cannot be written.
Status check_output_directory(const std::filesystem::path& path);
/// Entries of a directory, sorted by path. Errors (input): it cannot be read.
Result<std::vector<std::filesystem::path>> list_directory(const std::filesystem::path& path);

}  // namespace awmr
