/// Files: input read whole and within a bound, output that appears whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// The most that is read of one file or pipe: 1 GiB, ten million rows of a log.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U;

/// Errors: the file is missing, a directory, unreadable, longer than `max_bytes` or no longer what it
/// was when it was opened (another program writes it).
Result<std::string> read_file(const std::filesystem::path& path,
                              std::size_t max_bytes = kMaxFileBytes);

/// Writes beside `path`, flushes and renames, so that a reader sees the old file or the new one,
/// never part of either. A pipe or a terminal is written to as it is. Makes no directory. A symbolic
/// link stays and what it names is written, also where that is not there yet. What a killed program
/// left in the directory (`.awmr-PID-XXXXXX`) goes away.
/// Errors: as check_output; the disk is full.
Status write_file(const std::filesystem::path& path, std::string_view bytes);

struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
};

/// Files that belong together: all are written under temporary names, then renamed one after the
/// other. Where one cannot be written, none is. A program killed between two renamings (some
/// microseconds) leaves files of both sets: let the last one hold the hash of the others.
Status write_files(std::span<const OutputFile> files);

/// Whether `path` can be written without loss, to be asked before long work begins.
/// Errors: one of `inputs` by this or another name; a directory; a read-only file; a file with a
/// second name (hard link), which would keep the old bytes; its directory is missing or read-only.
Status check_output(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> inputs = {});

/// Makes `path` and its parents where they are missing.
Status make_directory(const std::filesystem::path& path);

}  // namespace awmr
