#include <algorithm>
#include <cmath>
#include <map>

#include "awmr/report/figures/figures_of.h"

namespace awmr {
namespace {

/// Role of a series for the yaw-control mode of a run.
Role role_of_mode(const Json& run) {
  static const std::map<std::string, Role> kRoles{{"differential", Role::kDifferential},
                                                  {"steering", Role::kSteering},
                                                  {"combined", Role::kCombined}};
  return kRoles.at(run["mode"]);
}

/// The runs of one scenario, one per mode. `scenario` is null if the scenario's file is missing.
struct ScenarioRuns {
  std::string stem;
  std::vector<const Json*> runs;
  Json scenario;
};

/// Returns for each scenario the runs with the tuned gains or, if there are none, those with the
/// paper's gains.
std::vector<ScenarioRuns> runs_by_scenario(const Json& data) {
  std::map<std::string, std::map<std::string, std::vector<const Json*>>> by_gains;
  for (const Json& run : data["runs"]) {
    by_gains[run["scenario"].get<std::string>()][run["gains"].get<std::string>()].push_back(&run);
  }
  std::vector<ScenarioRuns> all;
  for (auto& [stem, sets] : by_gains) {
    std::vector<const Json*>& runs = sets[sets.count("tuned") > 0 ? "tuned" : "paper"];
    // Draws the mode with the widest line first, so that all lines are visible where they coincide.
    std::sort(runs.begin(), runs.end(),
              [](const Json* a, const Json* b) { return role_of_mode(*a) < role_of_mode(*b); });
    all.push_back({stem, std::move(runs),
                   data["scenarios"].contains(stem) ? data["scenarios"][stem] : Json()});
  }
  return all;
}

std::vector<double> column(const Json& run, const char* name) {
  return run["columns"][name].get<std::vector<double>>();
}

Series line_of(const Json& run, const char* x, const char* y) {
  return {.name = run["mode"],
          .shape = SeriesShape::kLine,
          .role = role_of_mode(run),
          .x = column(run, x),
          .y = column(run, y)};
}

Series reference_of(const Json& run, const char* y) {
  return {.name = "reference",
          .shape = SeriesShape::kLine,
          .role = Role::kReference,
          .x = column(run, "t_s"),
          .y = column(run, y)};
}

/// The heading reference, shifted by whole turns to be nearest to the heading of the run: the
/// heading is continuous, but the reference can jump by a full turn.
Series heading_reference_of(const Json& run) {
  Series reference = reference_of(run, "psi_ref_deg");
  const std::vector<double> psi_deg = column(run, "psi_deg");
  for (std::size_t i = 0; i < psi_deg.size(); ++i) {
    reference.y[i] += 360.0 * std::round((psi_deg[i] - reference.y[i]) / 360.0);
  }
  return reference;
}

/// Panel with one signal of all runs over time.
Panel panel_of(const ScenarioRuns& one, const char* signal, Axis y) {
  Panel panel{.y = std::move(y), .series = {}};
  for (const Json* run : one.runs) panel.series.push_back(line_of(*run, "t_s", signal));
  return panel;
}

Figure figure_over_time(const ScenarioRuns& one, const char* kind, const std::string& meaning,
                        std::vector<Panel> panels) {
  return {.name = figure_name(kind, one.stem),
          .meaning = meaning + " of the simulated runs of " + one.stem,
          .x = {"t", "s"},
          .panels = std::move(panels)};
}

/// Figure of the heading. If the scenario commands headings, all runs have the same reference and
/// share one panel. Otherwise the guidance gives each run a reference of its own, so each run has
/// its own panel.
Figure heading_figure(const ScenarioRuns& one) {
  const Axis psi{"ψ", "deg"};
  std::vector<Panel> panels;
  const bool same =
      !one.scenario.contains("guidance") || one.scenario["guidance"].value("type", "") == "heading";
  if (same) {
    panels.push_back(panel_of(one, "psi_deg", psi));
    panels[0].series.push_back(heading_reference_of(*one.runs[0]));
  } else {
    for (const Json* run : one.runs) {
      panels.push_back(
          {.y = psi, .series = {line_of(*run, "t_s", "psi_deg"), heading_reference_of(*run)}});
    }
  }
  return figure_over_time(one, "heading", "Heading and its reference", std::move(panels));
}

Figure speed_figure(const ScenarioRuns& one) {
  Panel panel = panel_of(one, "u_mps", {"u", "m/s"});
  panel.series.push_back(reference_of(*one.runs[0], "u_ref_mps"));
  return figure_over_time(one, "speed", "Speed and its reference", {std::move(panel)});
}

/// The waypoints of a scenario, or the points of its line.
Series path_points(const Json& scenario) {
  Series points{.name = "", .shape = SeriesShape::kPoints, .role = Role::kReference};
  if (!scenario.contains("guidance")) return points;
  const Json& guidance = scenario["guidance"];
  points.name = guidance.value("type", "") == "waypoints" ? "waypoints" : "path";
  std::vector<Json> list;
  for (const char* key : {"from_m", "to_m"}) {
    if (guidance.contains(key)) list.push_back(guidance[key]);
  }
  if (guidance.contains("points_m")) list = guidance["points_m"].get<std::vector<Json>>();
  for (const Json& point : list) {
    points.x.push_back(point[0]);
    points.y.push_back(point[1]);
  }
  return points;
}

Figure path_figure(const ScenarioRuns& one) {
  Figure figure{.name = figure_name("path", one.stem),
                .meaning = "Paths of the simulated runs of " + one.stem,
                .x = {"x", "m"},
                .panels = {{.y = {"y", "m"}, .series = {}}},
                .equal_axes = true};
  for (const Json* run : one.runs) {
    figure.panels[0].series.push_back(line_of(*run, "x_m", "y_m"));
  }
  Series points = path_points(one.scenario);
  if (!points.x.empty()) figure.panels[0].series.push_back(std::move(points));
  if (!one.scenario.contains("obstacles")) return figure;
  for (const Json& o : one.scenario["obstacles"]) {
    figure.circles.push_back({o["x_m"], o["y_m"], o["radius_m"]});
  }
  return figure;
}

}  // namespace

void add_run_figures(const Json& data, FiguresOfResults& all) {
  const std::vector<ScenarioRuns> scenarios = runs_by_scenario(data);
  if (scenarios.empty()) {
    all.lacking.push_back(
        "heading, speed, forces, steering, path: there are no runs (run_SCENARIO_MODE_GAINS.csv), "
        "which awmr run writes");
  }
  for (const ScenarioRuns& one : scenarios) {
    all.figures.push_back(heading_figure(one));
    all.figures.push_back(speed_figure(one));
    all.figures.push_back(figure_over_time(
        one, "forces", "Left and right wheel forces divided by F_max",
        {panel_of(one, "force_left", {"F′_{L}"}), panel_of(one, "force_right", {"F′_{R}"})}));
    all.figures.push_back(figure_over_time(one, "steering", "Steering angle, commanded and actual",
                                           {panel_of(one, "steering_cmd_deg", {"δ_{cmd}", "deg"}),
                                            panel_of(one, "steering_deg", {"δ", "deg"})}));
    all.figures.push_back(path_figure(one));
  }
}

}  // namespace awmr
