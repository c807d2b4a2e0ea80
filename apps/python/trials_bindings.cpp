#include <fmt/format.h>

#include "awmr/core/column_mapping.h"
#include "awmr/trials/load.h"
#include "awmr/trials/log_files.h"
#include "bindings.h"
#include "identify_options.h"

namespace awmr::python {
namespace {

/// Types of the arguments of load_trials(): a path or nothing; also a list of paths for kinds of
/// trials that may have several files.
using Path = std::optional<std::filesystem::path>;
using Paths =
    std::variant<std::monostate, std::filesystem::path, std::vector<std::filesystem::path>>;

std::vector<std::filesystem::path> all_of(const Paths& paths) {
  if (const auto* one = std::get_if<std::filesystem::path>(&paths)) return {*one};
  if (const auto* many = std::get_if<std::vector<std::filesystem::path>>(&paths)) return *many;
  return {};
}

/// Returns one optional field of all rows as an array. The array is NaN in rows without this field.
template <class Row>
py::array optional_column(const std::vector<Row>& rows, std::optional<double> Row::*field) {
  return to_column(rows, [field](const Row& row) {
    return (row.*field).value_or(std::numeric_limits<double>::quiet_NaN());
  });
}

template <class Row>
py::array column(const std::vector<Row>& rows, double Row::*field) {
  return to_column(rows, [field](const Row& row) { return row.*field; });
}

template <class Row>
py::array lines(const std::vector<Row>& rows) {
  return to_column(rows, [](const Row& row) { return row.line; });
}

py::object surge_of(const TrialsOfFiles& trials) {
  if (!trials.data.surge) return py::none();
  const auto& rows = trials.data.surge->rows;
  py::dict columns;
  columns["line"] = lines(rows);
  columns["tau_speed"] = column(rows, &SurgeRow::tau_speed);
  columns["speed_mps"] = column(rows, &SurgeRow::speed_mps);
  columns["distance_m"] = optional_column(rows, &SurgeRow::distance_m);
  columns["elapsed_s"] = optional_column(rows, &SurgeRow::elapsed_s);
  return columns;
}

py::object turning_of(const TrialsOfFiles& trials) {
  if (!trials.data.turning) return py::none();
  const auto& rows = trials.data.turning->rows;
  py::dict columns;
  columns["line"] = lines(rows);
  columns["steering_rad"] = column(rows, &TurningRow::steering_rad);
  columns["wheel_force"] = column(rows, &TurningRow::wheel_force);
  columns["tau_turn_m"] = column(rows, &TurningRow::tau_turn_m);
  columns["yaw_rate_radps"] = column(rows, &TurningRow::yaw_rate_radps);
  columns["turns"] = optional_column(rows, &TurningRow::turns);
  columns["elapsed_s"] = optional_column(rows, &TurningRow::elapsed_s);
  return columns;
}

py::object stop_times_of(const TrialsOfFiles& trials) {
  if (!trials.data.coastdown) return py::none();
  const auto& rows = trials.data.coastdown->rows;
  py::dict columns;
  columns["line"] = lines(rows);
  columns["initial_speed_mps"] = column(rows, &StopTimeRow::initial_speed_mps);
  columns["stop_time_s"] = column(rows, &StopTimeRow::stop_time_s);
  return columns;
}

py::list curves_of(const TrialsOfFiles& trials) {
  py::list all;
  for (const CoastCurve& curve : trials.data.curves) {
    py::dict columns;
    columns["t_s"] = to_array(curve.t_s);
    columns["speed_mps"] = to_array(curve.speed_mps);
    all.append(columns);
  }
  return all;
}

/// Returns a log as a dict of arrays in SI units: time, commands and sensor channels. A channel is
/// NaN in rows in which it was not measured.
py::dict columns_of(const DrivingLog& log) {
  py::dict columns;
  columns["line"] = to_array(log.line);
  columns["t_s"] = to_array(log.t_s);
  columns["force_left"] = to_array(log.force_left);
  columns["force_right"] = to_array(log.force_right);
  if (log.steering_command_rad) {
    columns["steering_cmd_rad"] = to_array(*log.steering_command_rad);
  }
  for (const LogChannel channel : kChannels) {
    if (!log[channel]) continue;
    std::vector<double> values = log[channel]->value;
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!log[channel]->fresh[row]) values[row] = std::numeric_limits<double>::quiet_NaN();
    }
    columns[py::str(std::string(info(channel).name))] = to_array(values);
  }
  return columns;
}

py::list logs_of(const TrialsOfFiles& trials) {
  py::list all;
  for (const DrivingLog& log : trials.data.logs) all.append(columns_of(log));
  return all;
}

/// Argument `vehicle` of load_trials(): the result of read_vehicle(), or the vehicle of a model,
/// which has no file.
using AnyVehicle = std::variant<VehicleOfFile, Vehicle>;

/// Returns the input files with their hashes, in the order in which the command line records them:
/// the vehicle's file, if there is one, and the trial files. Errors (input): a file cannot be read.
Result<std::vector<InputFile>> inputs_of(const AnyVehicle& vehicle, const TrialFiles& files) {
  std::vector<InputFile> inputs;
  if (const auto* read = std::get_if<VehicleOfFile>(&vehicle)) inputs.push_back(read->file);
  AWMR_ASSIGN_OR_RETURN(const std::vector<InputFile> trials, input_files(paths_of(files)));
  inputs.insert(inputs.end(), trials.begin(), trials.end());
  return inputs;
}

TrialsOfFiles load(const AnyVehicle& vehicle, const Path& surge, const Path& turning,
                   const Paths& coastdown, const Paths& log,
                   const std::vector<std::string>& columns, const std::string& prefer, bool as_is,
                   bool steady_from_logs) {
  TrialOptions options{
      .columns = {}, .preference = value_of(kPreferenceNames, prefer, "prefer"), .as_is = as_is};
  for (const std::string& text : columns) {
    options.columns.push_back(value_or_raise(parse_column(text)));
  }
  const TrialFiles files{.surge = surge,
                         .turning = turning,
                         .coastdowns = all_of(coastdown),
                         .logs = all_of(log),
                         .steady_from_logs = steady_from_logs,
                         .options = std::move(options)};
  TrialsOfFiles trials{value_or_raise(
      load_trials(std::visit([](const Vehicle& any) { return any; }, vehicle), files))};
  trials.inputs = value_or_raise(inputs_of(vehicle, files));
  cli::describe_reading(files, trials.reading);
  trials.as_is = as_is;
  return trials;
}

}  // namespace

void bind_trials(py::module_& module) {
  py::class_<TrialsOfFiles>(module, "Trials",
                            "Trials in SI units. Each table is a dict from the name of a column to "
                            "a NumPy array, with NaN for an empty cell. Its column `line` has the "
                            "line number of each row in the file. A table without a file is None.")
      .def_readonly("vehicle", &TrialsOfFiles::vehicle)
      .def_readonly("findings", &TrialsOfFiles::findings)
      .def_property_readonly("surge", surge_of,
                             "straight runs: tau_speed (drive force divided by F_max), "
                             "speed_mps, ...")
      .def_property_readonly(
          "turning", turning_of,
          "steady turns: steering_rad (left positive), wheel_force (divided by F_max), "
          "yaw_rate_radps, ...")
      .def_property_readonly("coastdown", stop_times_of,
                             "coast-downs by stop time: initial_speed_mps, stop_time_s")
      .def_property_readonly("curves", curves_of, "list of coast-down curves: t_s, speed_mps")
      .def_property_readonly(
          "logs", logs_of,
          "list of driving logs, each a dict of columns: t_s, force_left and force_right (force "
          "of each wheel of that side divided by F_max), and, if logged, steering_cmd_rad and "
          "the sensor channels. A channel is NaN in rows without a reading");
  module.def("load_trials", load, py::arg("vehicle"), py::kw_only(), py::arg("surge") = py::none(),
             py::arg("turning") = py::none(), py::arg("coastdown") = std::monostate{},
             py::arg("log") = std::monostate{}, py::arg("columns") = std::vector<std::string>{},
             py::arg("prefer") = "printed", py::arg("as_is") = false,
             py::arg("steady_from_logs") = false,
             "Reads the trial files of one vehicle, given as paths; `coastdown` and `log` may be "
             "lists of paths. `columns`: column mappings as in --column, such as "
             "\"speed_mps=V*0.2778\". `prefer`: the value to use if a row gives its speed or yaw "
             "rate twice: \"printed\" (the number in the row) or \"timed\" (distance or turns over "
             "elapsed time). `as_is`: accept trials that contradict themselves or the vehicle, "
             "with a warning. `steady_from_logs`: also use steady stretches of the logs as surge "
             "and turning runs. Raises InputError with all faults of all files.");
}

}  // namespace awmr::python
