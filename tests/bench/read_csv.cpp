/// Reads the columns of a CSV file and prints the time used; for scripts/bench_csv. usage: read_csv
/// FILE [nohash]
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/file.h"

namespace {

double processor_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1000.0;
}

/// Returns all columns of the header, which is the first line.
awmr::Result<std::vector<awmr::CsvColumn>> columns_of(const std::string& path) {
  std::string line;
  std::getline(std::ifstream(path), line);
  AWMR_ASSIGN_OR_RETURN(const awmr::CsvHead head, awmr::csv_head(line, path, {}, {}, 0));
  std::vector<awmr::CsvColumn> columns;
  for (const std::string& name : head.names) columns.push_back({name});
  return columns;
}

awmr::Result<awmr::CsvTable> read_without_hash(const std::string& path,
                                               const std::vector<awmr::CsvColumn>& columns) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, awmr::read_file(path));
  return awmr::read_csv_text(text, path, columns);
}

awmr::Status run(const std::string& path, bool hash) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<awmr::CsvColumn> columns, columns_of(path));
  const double before_mb = peak_mb();
  const double before_s = processor_s();
  const auto begin = std::chrono::steady_clock::now();
  AWMR_ASSIGN_OR_RETURN(const awmr::CsvTable table,
                        hash ? awmr::read_csv(path, columns) : read_without_hash(path, columns));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const double kept_mb = static_cast<double>(table.rows() * columns.size()) * 8e-6;
  fmt::print(
      "{{\"rows\": {}, \"wall_s\": {:.4f}, \"processor_s\": {:.4f}, \"kept_mb\": {:.1f}, "
      "\"peak_mb\": {:.1f}}}\n",
      table.rows(), wall.count(), processor_s() - before_s, kept_mb, peak_mb() - before_mb);
  return {};
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return 2;
  const auto done = run(words[1], count < 3);
  if (!done) fmt::print(stderr, "{}", awmr::to_text(done.error()));
  return done ? 0 : 1;
}
