/// Reads whole files up to a maximum size, and writes files atomically.
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

/// Maximum size read from one file or pipe: 1 GiB, about ten million rows of a log.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U;

/// Reads a whole file. Errors: the file is missing, a directory, unreadable, longer than
/// `max_bytes`, modified while it is read, or a pipe that no program opens for writing within
/// kPipeWait_s.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::size_t max_bytes = kMaxFileBytes);

/// Function that checks the bytes of an output before they are written, by parsing them as the
/// commands do that later read the file. `file`: name of the file in errors.
using ReadBack = std::function<Status(std::string_view bytes, const std::string& file)>;

/// Writes a file: writes a temporary file next to `path`, flushes it and renames it to `path`. So
/// another program reads either the whole old file or the whole new one. Pipes and terminals are
/// written directly. A symbolic link stays, and its target is written, even if the target does not
/// exist yet. The directory must exist. Also removes temporary files (`.awmr-PID-XXXXXX`) that
/// killed programs left in this directory. Errors: those of check_output(); the disk is full;
/// `read_back` rejects the bytes, which is an internal error and leaves the old file unchanged.
Status write_file(const std::filesystem::path& path, std::string_view bytes,
                  const ReadBack& read_back = {});

struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
  ReadBack read_back = {};  ///< empty: no check, for files that no command reads
};

/// Writes a set of files: first all under temporary names, then renames them one after the other.
/// If a temporary file cannot be written, or a path is a pipe or a device, no file is changed. If
/// the program is killed between two renames (some microseconds), new and old files remain side by
/// side. To make this detectable, let the last file contain the hashes of all other files.
Status write_files(std::span<const OutputFile> files);

/// Checks that the output `path` can be written and is none of the inputs. Call it before a long
/// computation. Errors: `path` is one of `inputs`, by this or another name; it is a directory or a
/// read-only file; it has a second hard link, under which the old bytes would remain; its directory
/// is missing or read-only; its symbolic links form a loop.
Status check_output(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> inputs = {});

/// Makes the directory `path` and its missing parents. Errors: those of check_output_directory().
Status make_directory(const std::filesystem::path& path);

/// Maximum time to wait for a program at the other end of a pipe, s. If there were no limit, a pipe
/// that nobody opens would block the program for ever.
inline constexpr double kPipeWait_s = 5.0;

/// True if a file, a directory or anything else has this name. Symbolic links are followed. Errors
/// (input): the name cannot be looked up (a directory without search permission, a loop of links, a
/// name that is too long).
Result<bool> path_exists(const std::filesystem::path& path);
/// True if a directory has this name. Errors: those of path_exists().
Result<bool> directory_exists(const std::filesystem::path& path);
/// True if a regular file has this name. Errors (input): as path_exists(); a pipe, a device or a
/// directory has this name.
Result<bool> regular_file_exists(const std::filesystem::path& path);
/// Checks that `path` is a regular file or does not exist. Errors: those of regular_file_exists().
Status check_regular_file(const std::filesystem::path& path);
/// Checks that files can be made in the directory `path`, or that this directory can be made.
/// Errors (input): as path_exists(); the directory, or its nearest existing parent, is not a
/// writable directory; a name is too long.
Status check_output_directory(const std::filesystem::path& path);
/// Entries of a directory, sorted by path. Errors (input): the directory cannot be read.
Result<std::vector<std::filesystem::path>> list_directory(const std::filesystem::path& path);

}  // namespace awmr
