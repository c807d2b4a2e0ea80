#include "awmr/compare/compare.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tune_file.h"
#include "bindings.h"

namespace awmr::python {
namespace {

Tuning tuned(const Model& model, const std::optional<std::filesystem::path>& config, bool nominal,
             std::optional<int> draws) {
  TuneOptions options;
  if (config) options = value_or_raise(read_tune_config(*config)).options;
  options.nominal = options.nominal || nominal;
  if (draws) {
    if (*draws < 0 || *draws > 1000) throw Raised(input_error("draws", "0 to 1000").value());
    options.draws = *draws;
  }
  const py::gil_scoped_release released;
  return value_or_raise(tune(model, options));
}

py::list constraints_of(const Tuning& tuning) {
  py::list all;
  for (const ConstraintReport& report : tuning.constraints) {
    py::dict one;
    one["name"] = report.name;
    one["value"] = report.value;
    one["limit"] = report.limit;
    one["margin"] = report.margin;
    one["required"] = report.required;
    all.append(one);
  }
  return all;
}

py::list scores_of(const Tuning& tuning) {
  py::list all;
  for (const ModeScore& score : tuning.scores) {
    py::dict one;
    one["scenario"] = score.scenario;
    one["mode"] = name_of(score.mode);
    one["objective"] = score.objective;
    for (const auto& [name, value] : named_metrics(score.metrics)) {
      one[py::str(std::string(name))] = value;
    }
    all.append(one);
  }
  return all;
}

}  // namespace

void bind_tune(py::module_& module) {
  py::class_<Tuning>(module, "Tuning", "Gains and how they were found.")
      .def_readonly("gains", &Tuning::gains)
      .def_readonly("objective", &Tuning::objective, "1 for the paper's gains, less is better")
      .def_readonly("evaluations", &Tuning::evaluations)
      .def_readonly("algorithm", &Tuning::algorithm)
      .def_readonly("stop_reason", &Tuning::stop_reason)
      .def_property_readonly(
          "constraints", constraints_of,
          "list of dicts: name, value <= limit, margin = limit - value, required")
      .def_property_readonly("scores", scores_of,
                             "list of dicts by scenario and mode: objective and the metrics of "
                             "comparison.csv");
  module.def("tune", tuned, py::arg("model"), py::kw_only(), py::arg("config") = py::none(),
             py::arg("nominal") = false, py::arg("draws") = py::none(),
             "Searches the controller's gains under T2 < T1. `config`: path of tune.json; `draws`: "
             "plants from the model's covariance (default 4); `nominal`: none, no noise, no lag. "
             "The numbers are those of `awmr tune`. Raises Refused where no gains meet the "
             "constraints, InputError where the model lacks a parameter.");
}

}  // namespace awmr::python
