#include <fmt/format.h>
#include <pybind11/functional.h>

#include "awmr/identify/identify.h"
#include "awmr/identify/planning/suggest.h"
#include "bindings.h"
#include "identify_options.h"

namespace awmr::python {
namespace {

using Words = std::vector<std::string>;

/// Raises InputError if the value is outside [least, most]. This is the range of the corresponding
/// command-line option.
void check_within(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw Raised(input_error(ErrorCode::kOutOfRange, name,
                           fmt::format("expected {:g} to {:g}, found {:g}", least, most, value))
                   .value());
}

Identification fit(const TrialsOfFiles& trials, const std::optional<std::string>& method,
                   const std::optional<std::string>& noise, const Words& family,
                   const std::string& loss, bool joint, const Words& requested, std::uint64_t seed,
                   int starts, int bootstrap, double time_limit_s, int threads) {
  IdentifyOptions options;
  if (method) options.method = value_of(kMethodNames, *method, "method");
  if (noise) options.noise = value_of(kErrorModelNames, *noise, "noise");
  for (const std::string& name : family) value_or_raise(cli::add_family(name, options));
  for (const std::string& name : requested) value_or_raise(cli::add_requested(name, options));
  options.loss = value_of(kLossNames, loss, "loss");
  options.joint = joint;
  options.seed = seed;
  options.starts = starts;
  options.bootstrap = bootstrap;
  options.time_limit_s = time_limit_s;
  options.threads = threads;
  options.keeps_outliers = trials.as_is;
  check_within("starts", starts, 0, 1000);
  check_within("bootstrap", bootstrap, 0, 1000000);
  check_within("threads", threads, 0, 1024);
  check_within("time_limit_s", time_limit_s, 0, 1e6);
  Provenance provenance{"identify", cli::described(options), trials.inputs};
  provenance.options.insert(provenance.options.end(), trials.reading.begin(), trials.reading.end());
  const py::gil_scoped_release released;
  Identification identified = value_or_raise(identify(trials, options));
  identified.model.record.provenance = std::move(provenance);
  return identified;
}

py::list refused_names(const Identification& identification) {
  py::list names;
  for (const ParameterId id : identification.refused) names.append(info(id).name);
  return names;
}

py::list suggested(const Model& model, const std::string& parameter, int repeats) {
  check_within("repeats", repeats, 1, 1000);
  const Suggestion suggestion =
      value_or_raise(suggest(model, {.parameter = parameter, .repeats = repeats}));
  py::list trials;
  for (const MissingParameter& missing : suggestion.missing) {
    py::dict trial;
    trial["parameter"] = info(missing.id).name;
    trial["settings"] = missing.trial;
    trials.append(trial);
  }
  for (const SuggestedTrial& one : suggestion.trials) {
    py::dict trial;
    trial["kind"] = name_in(kTrialKindNames, one.kind);
    trial["settings"] = one.settings;
    py::dict numbers;
    for (const auto& [name, value] : one.numbers) numbers[py::str(name)] = value;
    trial["numbers"] = numbers;
    trial["parameter"] = one.parameter;
    trial["std_error_before"] = one.std_error_before;
    trial["std_error_after"] = one.std_error_after;
    trials.append(trial);
  }
  return trials;
}

}  // namespace

void bind_identify(py::module_& module) {
  py::class_<Identification>(module, "Identification",
                             "Result of identify(): a model, and the refused parameters.")
      .def_readonly("model", &Identification::model)
      .def_property_readonly(
          "refused", refused_names,
          "names of the requested parameters that the data do not identify (the command line then "
          "ends with exit code 1); model.findings has the reasons");
  module.def(
      "identify", fit, py::arg("trials"), py::kw_only(), py::arg("method") = py::none(),
      py::arg("noise") = py::none(), py::arg("family") = Words{}, py::arg("loss") = "squares",
      py::arg("joint") = false, py::arg("fit") = Words{}, py::arg("seed") = 1,
      py::arg("starts") = 6, py::arg("bootstrap") = 0, py::arg("time_limit_s") = 0.0,
      py::arg("threads") = 0,
      "Fits the parameters of a vehicle to its trials. The arguments are the options of the same "
      "names of `awmr identify`, and the results equal those of that command. `method`: "
      "\"log-linear\", \"nonlinear\" or \"trajectory\" (None: chosen by the data); `noise`: the "
      "quantity that has "
      "the errors, \"force\", \"speed\" or \"time\"; `family`, `fit`: lists of the values of "
      "--family and --fit; `time_limit_s`: 0 is no limit; `threads`: 0 is all cores, and the "
      "number does not change the results. Raises InputError.");
  module.def(
      "suggest", suggested, py::arg("model"), py::kw_only(), py::arg("parameter") = "",
      py::arg("repeats") = 3,
      "Returns the trials to record next, best first, as a list of dicts. The keys are `kind`, "
      "`settings` (text), `numbers` (the settings as a dict of numbers), and `parameter` (whose "
      "standard error the trial reduces). `std_error_before` and `std_error_after` are this "
      "standard error before and after the trial, in the parameter's unit. Arguments: "
      "`parameter` is the parameter whose standard error is to be reduced (\"\": all parameters "
      "together), `repeats` the number of runs of each trial. Trials for parameters without a "
      "value come first; these have only the keys `parameter` and `settings`. Raises InputError.");
}

}  // namespace awmr::python
