/// The commands of the program. Each command has a struct with its options, a function execute()
/// that runs it, and a function add_NAME() that adds it to the command line. The structs and
/// execute() functions here are those that other commands, such as `run`, use too; the others are
/// in the file of their command.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/emit/emit.h"
#include "awmr/identify/identify.h"
#include "awmr/trials/load.h"
#include "awmr/tune/tune.h"
#include "awmr/validate/validate.h"
#include "console.h"
#include "inputs.h"
#include "scenario_options.h"
#include "shard_option.h"

namespace awmr::cli {

namespace fs = std::filesystem;

struct IdentifyCommand {
  fs::path vehicle;
  TrialFiles trials;
  IdentifyOptions identify;
  fs::path output;
  /// Names under which the output file lists its inputs. Empty: the file names. Only `run` sets
  /// names.
  InputNames names = {};
};
Result<Outcome> execute(const IdentifyCommand& command);

struct TuneCommand {
  fs::path model;
  std::optional<fs::path> config;
  fs::path output;
  AllocationChoice allocation = {};
  bool nominal = false;
  /// true: tune a disturbance observer; false: tune none. A value that contradicts tune.json is an
  /// error. If absent, the keys `observer` and `no_observer` of tune.json decide.
  std::optional<bool> observer = {};
  std::optional<fs::path> baseline = {};  ///< replaces `baseline` of tune.json
  std::optional<YawMode> mode = {};       ///< replaces `mode` of tune.json
  bool one_set = false;                   ///< true: one set of gains for all modes
  bool allow_unsettled = false;           ///< true: also gains that never settle in some mode
  std::optional<int> draws = {};          ///< replaces `draws` of tune.json
  HeadingRateChoice heading_rate_limit = {};
  InputNames names = {};
};
Result<Outcome> execute(const TuneCommand& command);

struct ValidateCommand {
  fs::path model;
  std::optional<fs::path> gains;
  ValidateOptions validate;
  fs::path output;
  AllocationChoice allocation = {};
  std::vector<fs::path> logs = {};
  TrialOptions trials = {};  ///< column mappings and used time spans of the logs
  /// true: ignore column mappings for files that are not in `logs`; false: such a mapping is an
  /// error.
  bool other_columns = false;
  double horizon_s = 10.0;  ///< length of the windows in which logs are predicted, s
  /// Largest accepted NRMSE of the prediction of a channel over a window (RMS error divided by the
  /// standard deviation of the measurements).
  double log_tolerance = 0.3;
  /// True: also fit the tyres of the four-wheel model to the logs.
  bool tyres = false;
  bool claims = false;  ///< print the paper's fourteen claims, each with its criterion and reason
  std::optional<fs::path> claims_table = {};  ///< Markdown file for the claims
  /// If given: the vehicle drove this scenario under the controller while it recorded the logs.
  std::optional<fs::path> scenario = {};
  AcceptanceOptions acceptance = {};
  InputNames names = {};
};
Result<Outcome> execute(const ValidateCommand& command);

struct CompareCommand {
  fs::path model;
  std::vector<fs::path> gains;
  std::vector<fs::path> scenarios;
  CompareOptions compare;
  fs::path output;
  AllocationChoice allocation = {};
  HeadingRateChoice heading_rate_limit = {};
  PlantChoice plant = {.checks_other = true};
  /// Part of the runs that this call computes (`--shard`), as in compare.shard; empty: all runs.
  ShardChoice shard = {};
  InputNames names = {};
};
Result<Outcome> execute(const CompareCommand& command);

struct EmitCommand {
  fs::path model;
  fs::path gains;
  fs::path output;
  EmitOptions emit = {};
  bool header_only = false;  ///< write only awmr_params.h, without the library
  bool as_is = false;        ///< accept implausible dimensions of the vehicle
};
Result<Outcome> execute(const EmitCommand& command);

struct ReportCommand {
  fs::path directory;
  std::optional<fs::path> figures = {};  ///< directory for the print figures
};
Result<Outcome> execute(const ReportCommand& command);

/// Heading of the commands `schema`, `completion` and `man` in `awmr --help`.
inline constexpr const char* kServiceGroup = "For the shell and other programs";

void add_init(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_identify(CLI::App& app, Session& session);
void add_live(CLI::App& app, Session& session);
void add_recover(CLI::App& app, Session& session);
void add_suggest(CLI::App& app, Session& session);
void add_tune(CLI::App& app, Session& session);
void add_validate(CLI::App& app, Session& session);
void add_simulate(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_merge(CLI::App& app, Session& session);
void add_emit(CLI::App& app, Session& session);
void add_export(CLI::App& app, Session& session);
void add_pil(CLI::App& app, Session& session);
void add_map(CLI::App& app, Session& session);
void add_log(CLI::App& app, Session& session);
void add_compass(CLI::App& app, Session& session);
void add_report(CLI::App& app, Session& session);
void add_run(CLI::App& app, Session& session);
void add_explain(CLI::App& app, Session& session);
void add_schema(CLI::App& app, Session& session);
/// Add the commands that print completions and manual pages, which cover all commands.
void add_completion(CLI::App& app, Session& session);
void add_man(CLI::App& app, Session& session);

}  // namespace awmr::cli
