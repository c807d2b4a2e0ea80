/// Reads and writes run.csv, and writes its side file, `run.csv.json` next to `run.csv`. The side
/// file has the inputs, metrics and findings of the run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

struct Run;
struct Scenario;

/// Returns the content of run.csv: first the columns that every run has, then the columns that this
/// scenario adds. Precondition: the run has a row.
std::string run_csv(const Run& run, const Scenario& scenario);

/// Reads the columns of run.csv that every run has: time, state, commands and references. Errors:
/// those of read_csv(); the time decreases.
Result<CsvTable> read_run(const std::filesystem::path& path);

/// Checks that the text of a run.csv can be read, before it is written (ReadBack in core/file.h).
/// Errors: those of read_run().
Status check_run_text(std::string_view text, const std::string& file);

/// Returns the path of the side file: the path of the CSV file with `.json` appended.
std::filesystem::path run_side_path(const std::filesystem::path& csv);

/// Returns the content of the side file: `provenance`, the SHA-256 of the CSV text `csv`, the keys
/// of `figures`, and the findings. `figures` is the text of a JSON object, or empty. Precondition:
/// the other parts of the file have none of its keys.
std::string run_side_text(std::string_view csv, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings);

/// Checks that the file `side` may be written. Errors (input): a file with this name exists and is
/// not a side file of a run.
Status check_run_side(const std::filesystem::path& side);

/// The JSON Schema of the side file.
std::string run_schema();

}  // namespace awmr
