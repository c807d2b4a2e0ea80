#include "awmr/compare/compare.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/simulate/simulate.h"
#include "bindings.h"

namespace awmr::python {
namespace {

constexpr NameTable<RunEnd, 4> kRunEnds{{{"duration", RunEnd::kDuration},
                                         {"finished", RunEnd::kFinished},
                                         {"no-passage", RunEnd::kNoPassage},
                                         {"failed", RunEnd::kFailed}}};

/// A simulated run, with the inputs from which its metrics are computed.
struct EvaluatedRun {
  Run run;
  Scenario scenario;
  Metrics metrics;
};

EvaluatedRun simulated(const Model& model, const ModeGains& by_mode, const Scenario& scenario,
                       const std::string& mode_name) {
  const YawMode mode = value_of(kYawModeNames, mode_name, "mode");
  const Gains<double>& gains = by_mode.in(mode);
  const py::gil_scoped_release released;
  EvaluatedRun evaluated{.run = value_or_raise(simulate(model, gains, scenario, mode)),
                         .scenario = equipped(model.vehicle, scenario),
                         .metrics = {}};
  const Controller<double> controller = value_or_raise(controller_for(model, gains));
  evaluated.metrics = metrics_of(evaluated.run, evaluated.scenario, controller);
  evaluated.metrics.electric_work_j =
      electric_work_j(evaluated.metrics, model.vehicle, controller.mass_norm);
  return evaluated;
}

/// Columns of run.csv as a dict of arrays.
py::dict run_columns(const EvaluatedRun& evaluated) {
  const std::vector<RunRow>& rows = evaluated.run.rows;
  std::vector<std::string_view> names;
  std::vector<std::vector<double>> columns;
  for (const RunRow& row : rows) {
    const auto values = named_values(row, evaluated.scenario);
    if (names.empty()) {
      for (const auto& [name, value] : values) names.push_back(name);
      columns.resize(names.size());
      for (auto& column : columns) column.reserve(rows.size());
    }
    for (std::size_t i = 0; i < values.size(); ++i) columns[i].push_back(values[i].second);
  }
  py::dict arrays;
  for (std::size_t i = 0; i < names.size(); ++i) {
    arrays[py::str(std::string(names[i]))] = to_array(columns[i]);
  }
  return arrays;
}

py::dict metrics_dict(const Metrics& metrics) {
  py::dict values;
  for (const auto& [name, value] : named_metrics(metrics)) {
    values[py::str(std::string(name))] = value;
  }
  return values;
}

}  // namespace

void bind_simulate(py::module_& module) {
  py::class_<Scenario>(module, "Scenario",
                       "Scenario of a run, from scenario.json: the guidance (headings, waypoints, "
                       "...), obstacles, disturbances and sensor noise.")
      .def_readonly("name", &Scenario::name)
      .def_readonly("duration_s", &Scenario::duration_s, "longest duration of a run, s");
  bind_read(
      module, "read_scenario", [](const auto& path) { return read_scenario(path); },
      "Reads a scenario.json. Raises InputError.");
  py::class_<EvaluatedRun>(module, "Run", "One simulated run.")
      .def_property_readonly(
          "columns", run_columns,
          "run.csv as a dict of NumPy arrays, units in the names: t_s, x_m, y_m, psi_rad "
          "(unwrapped), u_mps, v_mps, r_radps, force_left, force_right (divided by F_max), "
          "steering_rad, ...; the commands of a row hold until the next row")
      .def_property_readonly(
          "metrics", [](const EvaluatedRun& evaluated) { return metrics_dict(evaluated.metrics); },
          "dict of the metrics of comparison.csv, units in the names; None if a metric does not "
          "apply")
      .def_property_readonly(
          "completed", [](const EvaluatedRun& evaluated) { return evaluated.metrics.completed; })
      .def_property_readonly(
          "end", [](const EvaluatedRun& evaluated) { return name_in(kRunEnds, evaluated.run.end); })
      .def(
          "csv",
          [](const EvaluatedRun& evaluated) { return run_csv(evaluated.run, evaluated.scenario); },
          "the bytes of run.csv");
  module.def("simulate", simulated, py::arg("model"), py::arg("gains"), py::arg("scenario"),
             py::kw_only(), py::arg("mode") = "combined",
             "Simulates one run of the model in a scenario. The controller has the model's "
             "parameters and these gains. `mode`: how the yaw moment is made: by the wheel forces "
             "(\"differential\"), by the \"steering\" or by both (\"combined\"). Raises InputError "
             "if the model lacks a parameter or the run diverges.");
}

}  // namespace awmr::python
