/// The commands of the program. Each command has a struct with its options, a function execute()
/// that runs it, and a function add_NAME() that adds it to the command line. The command `run`
/// calls the execute() functions of the other commands.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/emit/emit.h"
#include "awmr/emit/export.h"
#include "awmr/identify/identify.h"
#include "awmr/identify/planning/recover.h"
#include "awmr/trials/load.h"
#include "awmr/tune/tune.h"
#include "awmr/validate/validate.h"
#include "console.h"
#include "inputs.h"
#include "live_stream.h"
#include "scenario_options.h"
#include "shard_option.h"

namespace awmr::cli {

namespace fs = std::filesystem;

struct InitCommand {
  fs::path directory;
  /// true: write the paper's vehicle, tables, scenarios and synthetic logs, not an empty project
  bool example = false;
  Drive drive = Drive::kFourWheel;
};
Result<Outcome> execute(const InitCommand& command);
void add_init(CLI::App& app, Session& session);

struct CheckCommand {
  fs::path project;  ///< the project file or its directory
};
Result<Outcome> execute(const CheckCommand& command);
void add_check(CLI::App& app, Session& session);

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
void add_identify(CLI::App& app, Session& session);

/// Records a drive, meanwhile checks and fits the data repeatedly, and at the end identifies the
/// model.
struct LiveCommand {
  IdentifyCommand identify;  ///< options of the identification; execute() sets its logs
  StreamSource source = {};
  std::optional<fs::path> record = {};  ///< file of the recording; default: next to the model
  double every_s = 5.0;                 ///< interval between two updates of the display, > 0
  double budget_s = 5.0;                ///< time limit of an interim fit, > 0
  /// Target precision, > 0: a parameter is known well enough if the half width of its 95 %
  /// interval, divided by the value of the parameter, is at most this. For an exponent or another
  /// parameter that may be 0, the half width is not divided (Precision::half_width).
  double enough = 0.1;
  /// True: the recording ends as soon as every parameter is known well enough (`enough`).
  bool until_enough = false;
  double duration_s = 0.0;  ///< end the recording after this time; 0: no limit
  /// The recording ends after this time without data; 0: no limit.
  double idle_s = 0.0;
};
Result<Outcome> execute(const LiveCommand& command);
void add_live(CLI::App& app, Session& session);

struct RecoverCommand {
  fs::path model;
  RecoverOptions recover;
  ShardChoice shard = {};
  /// File recover.json. With `shard`: directory for the results of this part of the runs.
  std::optional<fs::path> output = {};
};
Result<Outcome> execute(const RecoverCommand& command);
void add_recover(CLI::App& app, Session& session);

struct SuggestCommand {
  fs::path model;
  std::string parameter;  ///< parameter or metric to improve; empty: all parameters
  std::optional<fs::path> gains;
  std::optional<fs::path> scenario;
  YawMode mode = YawMode::kCombined;
  int repeats = 3;  ///< runs of each suggested trial
  std::optional<fs::path> output;
};
Result<Outcome> execute(const SuggestCommand& command);
void add_suggest(CLI::App& app, Session& session);

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
  std::optional<int> draws = {};          ///< replaces `draws` of tune.json
  HeadingRateChoice heading_rate_limit = {};
  InputNames names = {};
};
Result<Outcome> execute(const TuneCommand& command);
void add_tune(CLI::App& app, Session& session);

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
void add_validate(CLI::App& app, Session& session);

struct SimulateCommand {
  fs::path model;
  std::optional<fs::path> gains;
  fs::path scenario;
  YawMode mode = YawMode::kCombined;
  fs::path output;
  AllocationChoice allocation = {};
  HeadingRateChoice heading_rate_limit = {};
  PlantChoice plant = {};
};
Result<Outcome> execute(const SimulateCommand& command);
void add_simulate(CLI::App& app, Session& session);

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
void add_compare(CLI::App& app, Session& session);

struct MergeCommand {
  std::vector<fs::path> parts;
  fs::path output;
};
Result<Outcome> execute(const MergeCommand& command);
void add_merge(CLI::App& app, Session& session);

struct EmitCommand {
  fs::path model;
  fs::path gains;
  fs::path output;
  EmitOptions emit = {};
  bool header_only = false;  ///< write only awmr_params.h, without the library
  bool as_is = false;        ///< accept implausible dimensions of the vehicle
};
Result<Outcome> execute(const EmitCommand& command);
void add_emit(CLI::App& app, Session& session);

struct ExportCommand {
  fs::path model;
  std::optional<fs::path> gains;
  ExportFormat format = ExportFormat::kRos2;
  fs::path output;
};
Result<Outcome> execute(const ExportCommand& command);
void add_export(CLI::App& app, Session& session);

void add_pil(CLI::App& app, Session& session);

struct MapCommand {
  fs::path file;
  std::optional<fs::path> vehicle;
  TrialKind trial = TrialKind::kLog;
  std::optional<fs::path> output;
};
Result<Outcome> execute(const MapCommand& command);
void add_map(CLI::App& app, Session& session);

struct LogCommand {
  fs::path file;
  fs::path output;
};
Result<Outcome> execute(const LogCommand& command);
void add_log(CLI::App& app, Session& session);

struct CompassCommand {
  fs::path file;
  double declination_deg = 0.0;
  ColumnWords columns = {};
  fs::path output;
};
Result<Outcome> execute(const CompassCommand& command);
void add_compass(CLI::App& app, Session& session);

struct ReportCommand {
  fs::path directory;
  std::optional<fs::path> figures = {};  ///< directory for the print figures
};
Result<Outcome> execute(const ReportCommand& command);
void add_report(CLI::App& app, Session& session);

struct RunCommand {
  fs::path project;
  fs::path output;
  bool figures = false;  ///< also write the print figures to `figures` in the output directory
};
Result<Outcome> execute(const RunCommand& command);
void add_run(CLI::App& app, Session& session);

struct ExplainCommand {
  std::optional<std::string> code;  ///< finding code to explain; empty: all codes
};
Result<Outcome> execute(const ExplainCommand& command);
void add_explain(CLI::App& app, Session& session);

/// Heading of the commands `schema`, `completion` and `man` in `awmr --help`.
inline constexpr const char* kServiceGroup = "For the shell and other programs";

void add_schema(CLI::App& app, Session& session);
/// Adds the commands that print completions and manual pages, which cover all commands.
void add_completion(CLI::App& app, Session& session);
void add_man(CLI::App& app, Session& session);

}  // namespace awmr::cli
