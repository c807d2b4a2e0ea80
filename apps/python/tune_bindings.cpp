#include "awmr/compare/compare.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tune_file.h"
#include "bindings.h"

namespace awmr::python {
namespace {

Tuning tuned(const Model& model, const std::optional<std::filesystem::path>& config, bool nominal,
             std::optional<int> draws, bool observer) {
  TuneOptions options;
  if (config) options = value_or_raise(read_tune_config(*config)).options;
  options.nominal = options.nominal || nominal;
  if (observer && !options.observer) options.observer.emplace();
  if (draws) {
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
    one["sense"] = std::string(name_in(kSenseNames, report.sense));
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

/// Results on fresh draws, as a list of dicts; empty for nominal gains.
py::list evaluated_gains_of(const Tuning& tuning) {
  py::list all;
  if (!tuning.robust) return all;
  for (const EvaluatedGains& evaluated : tuning.robust->evaluated) {
    py::dict one;
    one["gains"] = evaluated.gains;
    one["mode"] = name_of(evaluated.mode);
    one["completed_share"] = evaluated.completed_share;
    for (const EvaluatedFigure& figure : evaluated.figures) {
      py::dict values;
      values["median"] = figure.median;
      values["q95"] = figure.q95;
      values["tail_mean"] = figure.tail_mean;
      one[py::str(figure.name)] = values;
    }
    all.append(one);
  }
  return all;
}

/// Results of the goals, as a list of dicts; empty without goals.
py::list goals_of(const Tuning& tuning) {
  py::list all;
  if (!tuning.robust) return all;
  for (const EvaluatedGoal& evaluated : tuning.robust->goals) {
    py::dict limits;
    for (const GoalLimit& limit : evaluated.goal.at_most)
      limits[py::str(limit.figure)] = limit.most;
    py::dict one;
    one["gains"] = evaluated.gains;
    one["mode"] = name_of(evaluated.mode);
    one["at_most"] = limits;
    one["share"] = evaluated.goal.share;
    one["held"] = evaluated.held;
    one["runs"] = evaluated.runs;
    one["ci95"] = py::make_tuple(evaluated.ci95.lo, evaluated.ci95.hi);
    one["verdict"] = name_in(kGoalVerdictNames, evaluated.verdict);
    all.append(one);
  }
  return all;
}

}  // namespace

void bind_tune(py::module_& module) {
  py::class_<Tuning>(module, "Tuning", "Gains and the results of the tuning.")
      .def_readonly("gains", &Tuning::gains)
      .def_readonly("objective", &Tuning::objective, "1 for the baseline gains, lower is better")
      .def_readonly("evaluations", &Tuning::evaluations)
      .def_readonly("algorithm", &Tuning::algorithm)
      .def_readonly("stop_reason", &Tuning::stop_reason)
      .def_property_readonly(
          "constraints", constraints_of,
          "list of dicts: name, value <= limit, margin = limit - value, required")
      .def_property_readonly("scores", scores_of,
                             "list of dicts by scenario and mode: objective and the metrics of "
                             "comparison.csv")
      .def_property_readonly(
          "judged", evaluated_gains_of,
          "list of dicts by gains (\"robust\", \"baseline\", ...) and mode: each "
          "figure's median, q95 and tail_mean over fresh draws; empty for "
          "nominal gains")
      .def_property_readonly("goals", goals_of,
                             "list of dicts by gains, goal and mode: runs, runs that meet it, ci95 "
                             "of the share, and the verdict met, missed or open");
  module.def("tune", tuned, py::arg("model"), py::kw_only(), py::arg("config") = py::none(),
             py::arg("nominal") = false, py::arg("draws") = py::none(), py::arg("observer") = false,
             "Searches the controller's gains under T2 < T1. `config`: path of tune.json; `draws`: "
             "number of plants drawn from the model's covariance (default 32); `nominal`: tune for "
             "the nominal parameters without draws, noise and lag; `observer`: also tune a "
             "disturbance observer. The results equal those of `awmr tune`. Raises Refused if no "
             "gains meet the constraints, InputError if the model lacks a parameter.");
}

}  // namespace awmr::python
