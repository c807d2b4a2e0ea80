#include "awmr/compare/compare.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tune_file.h"
#include "bindings.h"

namespace awmr::python {
namespace {

Tuning tuned(const Model& model, const std::optional<std::filesystem::path>& config, bool nominal,
             std::optional<int> draws, std::optional<bool> observer) {
  TuneOptions options;
  if (config) options = value_or_raise(read_tune_config(*config)).options;
  options.nominal = options.nominal || nominal;
  if (const Status status = check_observer_choice(observer, options, "observer"); !status) {
    throw Raised(status.error());
  }
  choose_observer(observer, options);
  if (draws && options.nominal) {
    throw Raised(Error{ErrorKind::kInput,
                       {{ErrorCode::kConflict, "draws",
                         "needs randomly drawn vehicles, which nominal disables; remove one of the "
                         "two"}}});
  }
  if (draws) options.draws = *draws;
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

/// Results of each set of gains on newly drawn vehicles, as a list of dicts; empty if `nominal`.
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

/// Results of the goals of tune.json, as a list of dicts; empty without goals.
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

void bind_tuning(py::module_& module) {
  py::class_<Tuning>(module, "Tuning", "Result of tune(): the gains and how they perform.")
      .def_readonly("gains", &Tuning::gains)
      .def_property_readonly("mode_gains", &Tuning::mode_gains,
                             "ModeGains: the gains to use in each mode")
      .def_readonly("objective", &Tuning::objective,
                    "objective of the gains, lower is better; the baseline gains have 1")
      .def_readonly("evaluations", &Tuning::evaluations)
      .def_readonly("algorithm", &Tuning::algorithm)
      .def_readonly("stop_reason", &Tuning::stop_reason)
      .def_readonly("observer_added", &Tuning::observer_added,
                    "True if runs do not settle without an observer, so one was tuned")
      .def_property_readonly(
          "constraints", constraints_of,
          "list of dicts: name, value, limit, `sense` (on which side of its limit the value must "
          "be), `margin` (distance from the limit, >= 0 if met), and whether it is required")
      .def_property_readonly("scores", scores_of,
                             "list of dicts by scenario and mode, for the model's own parameters: "
                             "objective and the metrics of comparison.csv")
      .def_property_readonly(
          "judged", evaluated_gains_of,
          "list of dicts by gains (\"robust\": the tuned ones, \"baseline\", ...) and mode: for "
          "each metric its median, 95 % quantile `q95` and mean of the worst runs `tail_mean`, "
          "over new draws that the search did not use; empty if `nominal`")
      .def_property_readonly(
          "goals", goals_of,
          "list of dicts, one for each set of gains, goal of tune.json and mode: "
          "number of runs (`runs`), number of runs that meet the goal (`held`), "
          "95 % interval of their fraction (`ci95`), and `verdict`: \"met\", "
          "\"missed\" or \"open\" (undecided)");
}

}  // namespace

void bind_tune(py::module_& module) {
  bind_tuning(module);
  module.def(
      "tune", tuned, py::arg("model"), py::kw_only(), py::arg("config") = py::none(),
      py::arg("nominal") = false, py::arg("draws") = py::none(), py::arg("observer") = py::none(),
      "Searches the gains of the controller that minimise the objective and meet the "
      "constraints, such as T2 < T1. `config`: path of a tune.json; `draws`: number of random "
      "vehicles drawn from the model's covariance (default 32); `nominal`: tune for the model's "
      "own parameters, without draws, noise and lag; `observer`: True also tunes a disturbance "
      "observer, False tunes none, None (default) tunes one if `config` has one or if runs do "
      "not settle without it. The results equal those of `awmr tune`. Raises Refused if no gains "
      "meet the constraints, InputError if the model lacks a parameter or `config` is wrong.");
}

}  // namespace awmr::python
