#include <limits>

#include "awmr/compare/compare.h"
#include "awmr/simulate/validity.h"
#include "bindings.h"

namespace awmr::python {
namespace {

struct NamedComparison {
  Comparison comparison;
  CompareOptions options;
};

NamedComparison compared(const Model& model, const ModeGains& gains,
                         std::vector<Scenario> scenarios, int samples, std::uint64_t seed,
                         int threads, const py::object& heading_rate_limit) {
  CompareOptions options{.samples = samples, .seed = seed, .threads = threads};
  const HeadingRateChoice choice =
      heading_rate_limit.is_none() ? HeadingRateChoice() : std::string(py::str(heading_rate_limit));
  const py::gil_scoped_release released;
  value_or_raise(limit_heading_rate(rate_to_compare_at(choice, model), model, scenarios));
  Comparison comparison = value_or_raise(compare(model, gains, scenarios, options));
  return {std::move(comparison), std::move(options)};
}

/// Columns of comparison.csv as a dict of arrays; NaN where a metric does not apply.
py::dict comparison_columns(const NamedComparison& named) {
  const std::vector<ComparisonRow>& rows = named.comparison.rows;
  py::dict columns;
  py::list scenarios;
  py::list modes;
  for (const ComparisonRow& row : rows) {
    scenarios.append(row.scenario);
    modes.append(name_of(row.mode));
  }
  const py::object array = py::module_::import("numpy").attr("array");
  columns["scenario"] = array(scenarios);
  columns["mode"] = array(modes);
  columns["sample"] = to_column(rows, [](const ComparisonRow& row) { return row.sample; });
  columns["completed"] =
      to_column(rows, [](const ComparisonRow& row) { return row.metrics.completed ? 1 : 0; });
  std::vector<std::vector<double>> values;
  std::vector<std::string> names;
  for (const ComparisonRow& row : rows) {
    const auto metrics = named_metrics(row.metrics);
    if (names.empty()) {
      for (const auto& [name, value] : metrics) names.emplace_back(name);
      values.resize(names.size());
    }
    for (std::size_t i = 0; i < metrics.size(); ++i) {
      values[i].push_back(metrics[i].second.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) columns[py::str(names[i])] = to_array(values[i]);
  return columns;
}

}  // namespace

void bind_compare(py::module_& module) {
  py::class_<NamedComparison>(module, "Comparison",
                              "Result of compare(): the yaw-control modes on the same scenarios.")
      .def_property_readonly("columns", comparison_columns,
                             "comparison.csv as a dict of NumPy arrays, one row per run, units in "
                             "the names; NaN if a metric does not apply")
      .def(
          "csv", [](const NamedComparison& named) { return comparison_csv(named.comparison); },
          "the bytes of comparison.csv")
      .def(
          "table",
          [](const NamedComparison& named) {
            return comparison_table(named.comparison, named.options);
          },
          "metrics by scenario and mode, the ranking and a verdict, as text")
      .def("__str__", [](const NamedComparison& named) {
        return comparison_table(named.comparison, named.options);
      });
  module.def(
      "compare", compared, py::arg("model"), py::arg("gains"), py::arg("scenarios"), py::kw_only(),
      py::arg("samples") = 0, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("heading_rate_limit") = py::none(),
      "Compares the yaw-control modes on a list of scenarios, for the model's own values and for "
      "`samples` random vehicles from its covariance. The results equal those of `awmr compare`, "
      "for any number of threads (0: all cores). `heading_rate_limit`: limit of the rate of "
      "heading commands in deg/s, \"measured\" (the highest yaw rate of the trials) or \"none\"; "
      "default: \"measured\" if the model has such a yaw rate, else \"none\". Raises InputError.");
}

}  // namespace awmr::python
