#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/name_table.h"
#include "awmr/core/option_text.h"
#include "awmr/model/model_file.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/trials/trial_columns.h"
#include "commands.h"
#include "identify_words.h"
#include "live_fit.h"
#include "live_screen.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Reason why the recording ended.
enum class LiveEnd { kStream, kInterrupted, kDuration, kIdle, kEnough, kFull };
constexpr NameTable<LiveEnd, 6> kLiveEndWords{
    {{"the stream ended", LiveEnd::kStream},
     {"interrupted", LiveEnd::kInterrupted},
     {"the duration is over", LiveEnd::kDuration},
     {"no more data arrived", LiveEnd::kIdle},
     {"enough was recorded", LiveEnd::kEnough},
     {"the recording has reached its maximum size", LiveEnd::kFull}}};

/// Length of the first part of a recording, s, in which the display is updated every second, so
/// that a wrong unit is reported early.
constexpr double kAtFirst_s = 20.0;

std::vector<fs::path> inputs_of(const LiveCommand& command) {
  std::vector<fs::path> paths{command.identify.vehicle};
  if (command.source.log && *command.source.log != "-") paths.push_back(*command.source.log);
  for (const fs::path& path : paths_of(command.identify.trials)) paths.push_back(path);
  return paths;
}

/// Returns the path of the recording: the requested one, or a new file next to the model. Errors
/// (input): the new file exists already; the requested one is not a regular file, or is the model's
/// file.
Result<fs::path> record_of(const LiveCommand& command) {
  fs::path record =
      command.record.value_or(fs::path(command.identify.output).replace_extension("csv"));
  std::error_code error;
  if (!command.record && fs::exists(record, error)) {
    return input_error(ErrorCode::kWouldOverwrite, record.string(),
                       "this recording already exists; name another with --record FILE");
  }
  if (fs::exists(record, error) && !fs::is_regular_file(record, error)) {
    return input_error(
        ErrorCode::kWrongFile, "--record",
        record.string() +
            " is not a regular file, so the recording could not be read back for the fit; name "
            "another");
  }
  if (record.lexically_normal() == command.identify.output.lexically_normal()) {
    return input_error(
        ErrorCode::kConflict, "--record",
        "it is the model's file, which the recording would replace; give another name");
  }
  return record;
}

Status check(const LiveCommand& command) {
  if (command.source.port.has_value() == command.source.log.has_value()) {
    return input_error(ErrorCode::kMissing, "",
                       "give the source of the log: --port PORT, --log FILE or --log -");
  }
  return check_output(command.identify.output, inputs_of(command));
}

/// Returns the time of the next update. The pause before it is at least as long as the last update
/// took, so that updates use at most half of the time.
Clock::time_point next_look(Clock::time_point begin, Clock::time_point looked, double every_s) {
  const Clock::time_point now = Clock::now();
  const bool early = Seconds(now - begin).count() < kAtFirst_s;
  const double pause_s =
      std::max(early ? std::min(1.0, every_s) : every_s, Seconds(now - looked).count());
  return now + std::chrono::duration_cast<Clock::duration>(Seconds(pause_s));
}

struct Followed {
  Recording recording;
  LiveUpdate last;
  LiveEnd end = LiveEnd::kStream;
};

/// Returns the condition by which the recording ends now; empty if it goes on. `begin`: start of
/// the recording. `last_byte`: time of the last input.
std::optional<LiveEnd> end_condition(const LiveCommand& command, RecorderStream& stream,
                                     const Followed& followed, Clock::time_point begin,
                                     Clock::time_point last_byte) {
  const Clock::time_point now = Clock::now();
  const auto passed = [now](Clock::time_point since, double limit_s) {
    return limit_s > 0.0 && Seconds(now - since).count() >= limit_s;
  };
  if (Interruption::came()) return LiveEnd::kInterrupted;
  if (followed.recording.full()) return LiveEnd::kFull;
  if (stream.is_over()) return LiveEnd::kStream;
  if (passed(begin, command.duration_s)) return LiveEnd::kDuration;
  if (passed(last_byte, command.idle_s)) return LiveEnd::kIdle;
  if (command.until_enough && has_enough(followed.last)) return LiveEnd::kEnough;
  return std::nullopt;
}

/// Fits the data recorded so far. If the fit exceeds its time limit, the previous model is kept.
void update_fit(const LiveFit& fit, Followed& followed) {
  LiveUpdate update = fit.update(followed.recording);
  if (update.out_of_time) {
    update.model = std::move(followed.last.model);
    update.next = std::move(followed.last.next);
  }
  followed.last = std::move(update);
}

/// Records the data of the source until an end condition is met. At intervals, fits the recording
/// and shows the result.
Followed follow(const LiveCommand& command, const LiveFit& fit, OpenStream source,
                Recording recording, LiveScreen& screen) {
  const Interruption interruption;
  RecorderStream stream(std::move(source));
  Followed followed{.recording = std::move(recording), .last = {}};
  const Clock::time_point begin = Clock::now();
  Clock::time_point last_byte = begin;
  Clock::time_point look = begin;
  bool is_new = false;
  std::optional<LiveEnd> end;
  while (!end) {
    // Data may have arrived during the last update. They are added before the end conditions are
    // checked, because they would be lost if the recording ends now.
    const std::string bytes = stream.take(std::chrono::milliseconds(100));
    followed.recording.add(bytes);
    if (!bytes.empty()) last_byte = Clock::now();
    is_new = is_new || !bytes.empty();
    end = end_condition(command, stream, followed, begin, last_byte);
    if (end || !is_new || Clock::now() < look) continue;
    const Clock::time_point looked = Clock::now();
    update_fit(fit, followed);
    screen.show(followed.last);
    look = next_look(begin, looked, command.every_s);
    is_new = false;
  }
  followed.end = *end;
  followed.recording.finish();
  return followed;
}

/// Writes the complete recording, and the model that `identify` fits to it.
Result<Outcome> finished(const LiveCommand& command, const Followed& followed) {
  const fs::path& record = command.identify.trials.logs.front();
  AWMR_RETURN_IF_ERROR(write_file(record, followed.recording.text()));
  AWMR_ASSIGN_OR_RETURN(Outcome outcome, execute(command.identify));
  outcome.summary += fmt::format("{}: {} rows recorded\n", name_in(kLiveEndWords, followed.end),
                                 followed.recording.rows());
  LiveUpdate last{.enough = command.enough, .requested = command.identify.identify.requested};
  if (auto model = read_model(command.identify.output)) last.model = std::move(*model);
  if (last.model) {
    if (!has_enough(last)) last.next = next_manoeuvre(*last.model);
    outcome.summary += verdict_text(last) + "\n";
  }
  outcome.closing = fmt::format("wrote {}\n", record.string()) + outcome.closing;
  outcome.written.insert(outcome.written.begin(), record);
  const std::vector<Finding> damaged = followed.recording.findings(record.filename().string());
  append(outcome.findings, damaged);
  if (command.until_enough && !has_enough(last)) {
    outcome.refused = true;
    outcome.findings.push_back(
        {"", 0, Severity::kError, "not-enough",
         fmt::format("the recording ended ({}) before every half width of a 95 % "
                     "interval was within {:g} %: {}. Record a longer drive, with "
                     "the trials that awmr suggest lists",
                     name_in(kLiveEndWords, followed.end), 100.0 * command.enough,
                     widths_text(last))});
  }
  return outcome;
}

void add_source(CLI::App& sub, LiveCommand& live) {
  add_file(sub, "--port", live.source.port, "Serial port of the recorder, such as /dev/ttyUSB0");
  sub.add_option("--baud", live.source.baud, "Baud rate of --port (default 115200)")
      ->check(within(300U, 4000000U));
  add_file(sub, "--log", live.source.log,
           "CSV of a driving log that another program is writing; - for standard input");
  add_file(sub, "--record", live.record,
           "CSV file to which all received rows are written (default: the model's name with .csv; "
           "that file must not exist)");
}

void add_updates_and_end(CLI::App& sub, LiveCommand& live) {
  sub.add_option("--every", live.every_s,
                 "Seconds between two updates (default 5; 1 in the first 20 s)")
      ->check(within(0.05, 3600.0));
  sub.add_option("--budget", live.budget_s, "Time limit of a fit during the drive, s (default 5)")
      ->check(within(0.1, 3600.0));
  sub.add_option("--enough", live.enough,
                 "Half width of the 95 % interval at which a parameter is accurate enough: "
                 "relative to its value, for exponents absolute (default 0.1)")
      ->check(within(1e-6, 1.0));
  sub.add_flag("--until-enough", live.until_enough,
               "End as soon as every requested parameter is as accurate as --enough requires; "
               "exit code 1 if the recording ends before");
  sub.add_option("--duration", live.duration_s, "End after this time, s (default: never)")
      ->check(within(0.1, 1e6));
  sub.add_option("--idle", live.idle_s, "End after this time without input, s (default: never)")
      ->check(within(0.1, 1e6));
}

Result<Outcome> execute(const LiveCommand& requested) {
  AWMR_RETURN_IF_ERROR(check(requested));
  LiveCommand command = requested;
  AWMR_ASSIGN_OR_RETURN(const fs::path record, record_of(command));
  AWMR_RETURN_IF_ERROR(check_output(record, inputs_of(command)));
  command.identify.trials.logs = {record};
  AWMR_ASSIGN_OR_RETURN(Vehicle vehicle, read_vehicle(command.identify.vehicle));
  if (!command.identify.trials.options.as_is) {
    AWMR_RETURN_IF_ERROR(check_plausible(vehicle, command.identify.vehicle.string() + ":",
                                         "Correct it, or give " + option_text("as-is")));
  }
  AWMR_ASSIGN_OR_RETURN(const TrialOptions options,
                        with_vehicle_columns(command.identify.trials.options, vehicle));
  AWMR_ASSIGN_OR_RETURN(OpenStream source, open_stream(command.source));
  LiveScreen screen("recording " + record.string());
  const LiveFit fit(command, std::move(vehicle));
  const Followed followed =
      follow(command, fit, std::move(source), Recording(options.columns), screen);
  if (followed.recording.text().empty()) {
    return input_error(
        ErrorCode::kTooFewData,
        command.source.port.value_or(command.source.log.value_or("")).string(),
        fmt::format("{} before any data arrived; check that the recorder writes to this source",
                    name_in(kLiveEndWords, followed.end)));
  }
  screen.say(fmt::format("{}: {} rows are in {}; fitting the whole recording",
                         name_in(kLiveEndWords, followed.end), followed.recording.rows(),
                         record.string()));
  return finished(command, followed);
}

}  // namespace

void add_live(CLI::App& app, Session& session) {
  struct Words {
    IdentifyWords identify;
    LiveCommand live;
  };
  auto words = std::make_shared<Words>();
  CLI::App* sub =
      add_command(app, session, "live", "Record a drive, and check and fit it while driving",
                  "awmr live --vehicle configs/paper/vehicle.json --log - -o live.json "
                  "< datasets/synthetic/drive_1.csv",
                  [words]() -> Result<Outcome> {
                    LiveCommand command = words->live;
                    AWMR_ASSIGN_OR_RETURN(command.identify, command_of(words->identify));
                    return execute(command);
                  });
  add_table_files(*sub, words->identify.command);
  add_source(*sub, words->live);
  add_updates_and_end(*sub, words->live);
  add_fit_options(*sub, words->identify);
  add_log_options(*sub, words->identify.command);
  add_reading_options(*sub, words->identify);
  add_output(*sub, words->identify.command.output, "model.json to write");
}

}  // namespace awmr::cli
