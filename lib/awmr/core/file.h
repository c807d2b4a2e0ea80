/// Files: bounded whole-file input and atomic output.
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

/// Maximum size read from one file or pipe: 1 GiB, ten million rows of a log.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U;

/// Reads a whole file. Errors: it is missing, a directory, unreadable, longer than `max_bytes`,
/// modified since it was opened, or a pipe that no program opens for writing within kPipeWait_s.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::size_t max_bytes = kMaxFileBytes);

/// Reads an output's bytes like the command that uses the file; `file` names it in errors.
using ReadBack = std::function<Status(std::string_view bytes, const std::string& file)>;

/// Writes a temporary file next to `path`, flushes and renames it, so that a reader sees the old
/// file or the new one, never part of either. Pipes and terminals are written directly. Makes no
/// directory. A symbolic link is kept and its target written, even if the target is missing.
/// Removes temporary files (`.awmr-PID-XXXXXX`) that killed programs left in the directory.
/// Errors: as check_output; the disk is full; (fault) `read_back` rejects the bytes, and the old
/// file is kept.
Status write_file(const std::filesystem::path& path, std::string_view bytes,
                  const ReadBack& read_back = {});

struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
  ReadBack read_back = {};  ///< empty: no program reads this file
};

/// Writes a set of files: all under temporary names, then renames one after the other. If one
/// cannot be written, or is a pipe or a device, none is. A program killed between two renames (some
/// microseconds) leaves files of both sets: let the last file hold the hashes of the others.
Status write_files(std::span<const OutputFile> files);

/// Checks that `path` can be written without loss. Call before long work. Errors: it is one of
/// `inputs`, by this or another name; a directory; a read-only file; a file with a second hard
/// link, which would keep the old bytes; its directory is missing or read-only.
Status check_output(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> inputs = {});

/// Makes `path` and its missing parents. Errors: as check_output_directory.
Status make_directory(const std::filesystem::path& path);

/// Maximum wait for the program at the other end of a pipe, s.
inline constexpr double kPipeWait_s = 5.0;

/// File system queries; symbolic links are followed. False: nothing has this name. Errors (input):
/// the name cannot be looked up (a directory without search permission, a loop of links, a name
/// that is too long).
Result<bool> path_exists(const std::filesystem::path& path);
Result<bool> directory_exists(const std::filesystem::path& path);
/// For files found by their name in a directory. Errors (input): as above; the name belongs to a
/// pipe, a device or a directory.
Result<bool> regular_file_exists(const std::filesystem::path& path);
/// As regular_file_exists(), but a missing file is not an error.
Status check_regular_file(const std::filesystem::path& path);
/// Checks that files can be made in `path`, or `path` itself if it is missing. Errors (input): the
/// directory, or its nearest existing parent, is not writable.
Status check_output_directory(const std::filesystem::path& path);
/// Entries of a directory, sorted by path. Errors (input): it cannot be read.
Result<std::vector<std::filesystem::path>> list_directory(const std::filesystem::path& path);

}  // namespace awmr
