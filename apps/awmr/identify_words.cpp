#include "identify_words.h"

#include <CLI/CLI.hpp>

#include "identify_options.h"
#include "option_values.h"

namespace awmr::cli {

Result<IdentifyCommand> command_of(const IdentifyWords& words) {
  IdentifyCommand command = words.command;
  AWMR_ASSIGN_OR_RETURN(command.trials.options.columns, column_mappings(words.columns));
  AWMR_RETURN_IF_ERROR(use_parts(words.excluded, command.trials.options));
  for (const std::string& name : words.requested) {
    AWMR_RETURN_IF_ERROR(add_requested(name, command.identify));
  }
  for (const std::string& name : words.families) {
    AWMR_RETURN_IF_ERROR(add_family(name, command.identify));
  }
  command.identify.keeps_outliers = command.trials.options.as_is;
  return command;
}

void add_table_files(CLI::App& sub, IdentifyCommand& command) {
  add_file(sub, "--vehicle", command.vehicle, "vehicle.json: known properties of the vehicle")
      ->required();
  add_file(sub, "--surge", command.trials.surge, "CSV of runs at constant thrust, wheels straight");
  add_file(
      sub, "--coastdown", command.trials.coastdowns,
      "CSV of coast-downs, motors off: stop times, whole curves or times per speed bin; may be "
      "repeated");
  add_file(sub, "--turning", command.trials.turning, "CSV of runs at constant thrust and steering");
}

void add_fit_options(CLI::App& sub, IdentifyWords& words) {
  IdentifyOptions& options = words.command.identify;
  add_choice(sub, "--method", options.method, kMethodNames,
             "Estimator of the model's parameters: log-linear (default for tables), nonlinear, "
             "trajectory (default with --log)");
  add_choice(sub, "--noise", options.noise, kErrorModelNames,
             "Quantity that has the measurement error in the nonlinear fit: force, speed or "
             "time (default with --method nonlinear: time if every run was timed, else speed)");
  sub.add_option(
         "--family", words.families,
         "Family (formula) of the resistance laws: power (default; a fit of logs uses another "
         "family if that is significantly better), coulomb-linear, coulomb-linear-quadratic, "
         "coulomb-power, dead-zone, dead-zone-coulomb (logs only), or auto (best fit for its "
         "number of parameters, by AICc); "
         "surge=NAME or yaw=NAME selects the family of one law")
      ->delimiter(',');
  add_choice(sub, "--loss", options.loss, kLossNames,
             "Loss function of the residuals: squares (default) or, "
             "with less weight for large errors, huber, cauchy or tukey");
  sub.add_flag("--joint", options.joint,
               "Fit the surge resistance (a1, b1) and m' (mass divided by F_max) together to the "
               "surge runs and the coast-down curves");
  sub.add_option("--fit", words.requested,
                 "Parameters to fit, e.g. surge.alpha,mass_norm; for logs also all, "
                 "input_delay_s, bias.yaw_rate_radps, ...")
      ->delimiter(',');
}

void add_log_options(CLI::App& sub, IdentifyCommand& command) {
  sub.add_flag("--steady-from-log", command.trials.steady_from_logs,
               "Use steady stretches of the logs as surge and turning runs");
  sub.add_option("--starts", command.identify.starts,
                 "Number of random initial guesses of a log fit without tables (default 6)")
      ->check(within(0, 1000));
  sub.add_option("--bootstrap", command.identify.bootstrap,
                 "Number of block-bootstrap resamples of the logs, from which the shape of the "
                 "intervals is computed (default 0: intervals from the covariance alone)")
      ->check(within(0, 1000000));
  sub.add_option("--time-limit", command.identify.time_limit_s,
                 "Time limit for log fits, s (default: none). Fits that have not converged by then "
                 "are refused. If not all resistance families were compared, the intervals are "
                 "withdrawn. With a limit, the result depends on the speed of the machine")
      ->check(within(0.1, 1e6));
  sub.add_option("--seed", command.identify.seed,
                 "Random seed of the starts and of the bootstrap (default 1)")
      ->check(within<std::uint64_t>(0, kAnySeed));
  sub.add_option("--threads", command.identify.threads,
                 "Number of threads (default: all cores); the result does not depend on it")
      ->check(within(1, 1024));
}

void add_end_options(CLI::App& sub, TrialOptions& trials, std::vector<std::string>& excluded) {
  sub.add_option("--until", trials.used_s.hi, "Use each log up to this time, s")
      ->check(within(-kMaxTime_s, kMaxTime_s));
  sub.add_option("--exclude", excluded,
                 "A:B: leave out each log's rows from time A to time B, s; the parts before and "
                 "after count as two logs; may be repeated");
}

void add_reading_options(CLI::App& sub, IdentifyWords& words) {
  sub.add_flag(
      "--as-is", words.command.trials.options.as_is,
      "Accept trials that appear to have wrong units or signs, or left and right exchanged, "
      "and keep gross outliers");
  add_choice(sub, "--prefer", words.command.trials.options.preference, kPreferenceNames,
             "Value to use if a row gives its speed or yaw rate twice and the two disagree: "
             "printed (the number in the row, default) or timed (computed from the distance or "
             "turns and the elapsed time)");
  sub.add_option("--column", words.columns.columns, kColumnHelp);
  add_file(sub, "--columns-file", words.columns.file, kColumnsFileHelp);
}

}  // namespace awmr::cli
