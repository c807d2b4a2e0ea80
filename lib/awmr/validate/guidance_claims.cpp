// Checks of the claims C8 to C12: waypoints, line, obstacles, timed path, best modes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "awmr/core/units.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/validate/claims.h"
#include "awmr/validate/paper_scenarios.h"

namespace awmr {
namespace {

/// Criterion of C9, that the distance d from the line tends to 0: largest |d| in the last quarter
/// of the run, as a fraction of R, the distance from the line up to which the approach angle of the
/// guidance law is proportional to d.
constexpr double kOnTheLineShare = 0.01;
/// Criterion of C10, that the modes avoid obstacles alike: the longest finishing time of a mode
/// exceeds the shortest by at most this fraction.
constexpr double kAlikeShare = 0.10;
/// Criterion of C11, that the vehicle follows the timed path: largest distance from the moving
/// point of the path. Chosen as a twentieth of the path's width of 20 m, because a smaller distance
/// is hardly visible in a printed figure.
constexpr double kPathTolerance_m = 1.0;
/// A value counts as equal to the best value if it is at most this fraction larger.
constexpr double kAsGoodShare = 0.01;

/// Returns a scenario of paper_scenario_files(). Precondition: it has a file of this name.
Scenario paper_scenario(std::string_view name) {
  const auto& files = paper_scenario_files();
  const auto file = std::ranges::find(files, name, &EmbeddedFile::path);
  return scenario_from_text(file->bytes, std::string(name)).value();
}

double largest_steering_deg(const ModeRun& run) {
  double largest = 0.0;
  for (const RunRow& row : run.run.rows) {
    largest =
        std::max({largest, std::abs(row.state.steering_rad), std::abs(row.steering_command_rad)});
  }
  return degrees(largest);
}

bool completed(const ModeRun& run) { return run.metrics.completed; }

/// Names of the modes for which `condition` does not hold: "steering", "steering and combined".
template <class Condition>
std::string modes_without(const ModeRuns& runs, Condition condition) {
  std::string names;
  for (const ModeRun& run : runs) {
    if (condition(run)) continue;
    names += (names.empty() ? "" : " and ") + std::string(name_of(run.mode));
  }
  return names;
}

Claim waypoints_reached(const ModeRuns& runs) {
  constexpr double kStop_deg = 20.0;  // the paper's steering stop [paper 5.1]
  const auto within = [&](const ModeRun& run) {
    return largest_steering_deg(run) <= kStop_deg + 1e-9;
  };
  const bool reached = all_modes(runs, completed);
  const bool all_within = all_modes(runs, within);
  Claim claim{
      .id = "C8",
      .statement =
          "with line-of-sight guidance, the vehicle reaches the waypoints E, F, G and H with a "
          "steering angle |d_r| of at most 20 deg",
      .reproduced = reached && all_within,
      .figure = fmt::format("time to the last waypoint: {}; largest |d_r|: {}; path length: {}",
                            by_mode(runs, "s", &Metrics::finish_time_s),
                            by_mode(runs, "deg", largest_steering_deg),
                            by_mode(runs, "m", &Metrics::path_length_m)),
      .tolerance =
          "the vehicle passes each waypoint within 1 m (chosen here, because the paper prints no "
          "radius), and |d_r| is at most 20 deg",
      .why = {},
      .modes = verdicts_by_mode(runs,
                                [&](const ModeRun& run) { return completed(run) && within(run); })};
  claim.why = !reached ? "not all waypoints are reached in 180 s: the turns are too wide for the "
                         "acceptance radius in " +
                             modes_without(runs, completed) + " mode"
              : !all_within
                  ? "the largest steering angle of this vehicle is above 20 deg"
                  : "the waypoints are far enough apart for the turns of every mode, and the "
                    "allocation limits d_r to the largest steering angle. The path is longest in "
                    "the mode with the widest turns; in the paper, it is longest in combined mode";
  return claim;
}

/// Largest cross-track error |e| over the last quarter of the run, m.
double final_cross_track_m(const ModeRun& run) {
  double largest = 0.0;
  const auto& rows = run.run.rows;
  for (std::size_t i = rows.size() - rows.size() / 4; i < rows.size(); ++i) {
    largest = std::max(largest, std::abs(rows[i].path.cross_track_m));
  }
  return largest;
}

Claim line_followed(const ModeRuns& runs) {
  const Scenario scenario = paper_scenario("c9_line");
  const auto& law = std::get<LineOfSight<double>>(std::get<LinePath>(scenario.guidance).law);
  const double accepted_m = kOnTheLineShare * law.width_m;
  const auto on_it = [&](const ModeRun& run) {
    return completed(run) && final_cross_track_m(run) <= accepted_m;
  };
  const bool all_on_it = all_modes(runs, on_it);
  return {
      .id = "C9",
      .statement = "when the vehicle follows a line, its distance d from the line tends to 0",
      .reproduced = all_on_it,
      .figure = "largest |d| in the last quarter of the run (8.9 m at the start): " +
                by_mode(runs, "m", final_cross_track_m),
      .tolerance = fmt::format("this distance is at most {} m, {:.0f} % of the width R of the "
                               "guidance law, and the vehicle passes the end of the line",
                               accepted_m, 100.0 * kOnTheLineShare),
      .why =
          all_on_it
              ? "the guidance law corrects the heading for the sideslip angle. As soon as the "
                "vehicle has the commanded heading, d_dot = -U sin(Delta sat(d/R)) [paper (113)] "
                "with the speed U and the approach angle Delta beyond R, so d decreases to 0"
              : "the heading does not follow its command closely enough in " +
                    modes_without(runs, on_it) + " mode",
      .modes = verdicts_by_mode(runs, on_it)};
}

bool alike(const ModeRuns& runs) {
  double least = 1e300;
  double most = 0.0;
  for (const ModeRun& run : runs) {
    least = std::min(least, run.metrics.finish_time_s.value_or(0.0));
    most = std::max(most, run.metrics.finish_time_s.value_or(1e300));
  }
  return most <= (1.0 + kAlikeShare) * least;
}

Claim obstacles_avoided(const ModeRuns& line, const ModeRuns& points) {
  const bool avoided = all_modes(line, completed) && all_modes(points, completed);
  const bool same = alike(line) && alike(points);
  const auto figure = [](const char* where, const ModeRuns& runs) {
    return fmt::format("{0}, smallest clearance: {1}; {0}, finishing time: {2}", where,
                       by_mode(runs, "m", &Metrics::clearance_min_m),
                       by_mode(runs, "s", &Metrics::finish_time_s));
  };
  return {
      .id = "C10",
      .statement =
          "the three modes avoid obstacles about equally well, on a line and between waypoints",
      .reproduced = avoided && same,
      .figure = figure("on the line", line) + "; " + figure("between waypoints", points),
      .tolerance = fmt::format(
          "in every mode, the vehicle touches no obstacle (clearance above 0) and completes both "
          "paths. On each path, the slowest mode takes at most {:.0f} % longer than the fastest",
          100.0 * kAlikeShare),
      .why =
          !avoided
              ? "in at least one mode, the vehicle touches an obstacle or does not complete a path"
          : !same ? "all modes avoid the obstacles, but one has wider turns and takes too long"
                  : "the avoidance begins so early that even the mode with the widest turns has "
                    "room. The avoidance rule is the project's own, because the figure with the "
                    "paper's rule is missing"};
}

/// Largest distance of the vehicle from the point of the path at the same time, m.
double off_path_m(const ModeRun& run) {
  double largest = 0.0;
  for (const RunRow& row : run.run.rows) {
    largest = std::max(largest, distance_m(row.path.target_m, {row.state.x_m, row.state.y_m}));
  }
  return largest;
}

/// Smallest radius of curvature of the path p(t), m: |p_dot|^3/|p_dot x p_ddot|, i.e. the speed
/// divided by the yaw rate.
double least_radius_m(const Lissajous<double>& path, double duration_s) {
  double least = 1e300;
  for (double t_s = 0.0; t_s < duration_s; t_s += 0.1) {
    const PathGuidance<double> at = open_path(path.at(t_s), 0.0);
    least = std::min(least, at.speed_mps / std::max(std::abs(at.psi_rate_radps), 1e-12));
  }
  return least;
}

/// Results of off_path_m() by mode. Keeping them instead of the runs saves memory.
using OffPath = std::map<YawMode, double>;
OffPath off_path_by_mode(const ModeRuns& runs) {
  OffPath off;
  for (const ModeRun& run : runs) off[run.mode] = off_path_m(run);
  return off;
}

Claim timed_path_followed(const ModeRuns& open, const OffPath& closed_off_m) {
  const Scenario open_scenario = paper_scenario("c11_lissajous");
  const OffPath off_m = off_path_by_mode(open);
  const auto off = [&](const ModeRun& run) { return off_m.at(run.mode); };
  const auto closed_off = [&](const ModeRun& run) { return closed_off_m.at(run.mode); };
  const auto followed = [&](const ModeRun& run) { return off(run) <= kPathTolerance_m; };
  const bool all = all_modes(open, followed);
  const double radius_m = least_radius_m(std::get<LissajousPath>(open_scenario.guidance).path,
                                         open_scenario.duration_s);
  const std::string slow = modes_without(open, followed);
  return {
      .id = "C11",
      .statement =
          "the vehicle follows a point that moves on the Lissajous path x = 10 cos 0.01t, y = 10 "
          "sin 0.03t (m, t in s)",
      .reproduced = all,
      .figure = fmt::format("largest distance from the moving point, without position feedback (as "
                            "in the paper): {}; with position feedback: {}",
                            by_mode(open, "m", off), by_mode(open, "m", closed_off)),
      .tolerance = fmt::format("without position feedback, this distance is at most {} m (5 % of "
                               "the path's width) in every mode",
                               kPathTolerance_m),
      .why = all ? "every mode can make the tightest turn of the path, and the simulation has no "
                   "disturbances that position feedback would have to correct"
                 : fmt::format(
                       "the smallest radius of the path is {:.2f} m, too tight for {} mode. "
                       "Without position feedback, the resulting position error is not corrected",
                       radius_m, slow),
      .modes = verdicts_by_mode(open, followed)};
}

/// True if `mode` has the smallest value or is within kAsGoodShare of it.
template <class Value>
bool is_best(const ModeRuns& runs, YawMode mode, Value value) {
  const auto own = value_of(in_mode(runs, mode), value);
  if (!own) return false;
  return all_modes(runs, [&](const ModeRun& run) {
    const auto other = value_of(run, value);
    return !other || *own <= (1.0 + kAsGoodShare) * *other;
  });
}

std::string along(const char* where, const ModeRuns& runs) {
  return fmt::format(
      "{0}, finishing time: {1}; {0}, RMS cross-track error: {2}; {0}, speed drop: {3}", where,
      by_mode(runs, "s", &Metrics::finish_time_s), by_mode(runs, "m", &Metrics::cross_track_rms_m),
      by_mode(runs, "m/s", &Metrics::speed_drop_mps));
}

Claim best_modes(const ModeRuns& points, const ModeRuns& path) {
  const auto best_for = [](const ModeRuns& runs, YawMode mode) {
    return is_best(runs, mode, &Metrics::finish_time_s) &&
           is_best(runs, mode, &Metrics::cross_track_rms_m);
  };
  const bool at_waypoints = best_for(points, YawMode::kCombined);
  const bool along_line = best_for(path, YawMode::kCombined);
  const auto differential = [&](auto value) {
    return is_best(points, YawMode::kDifferential, value) &&
           is_best(path, YawMode::kDifferential, value);
  };
  const bool speed = differential(&Metrics::speed_drop_mps);
  constexpr double percent = 100.0 * kAsGoodShare;
  return {
      .id = "C12",
      .statement =
          "combined mode is best for waypoints and paths, differential mode for holding the speed",
      .reproduced = at_waypoints && along_line && speed,
      .figure = along("waypoints", points) + "; " + along("polyline", path),
      .tolerance =
          fmt::format("on both paths (waypoints and polyline), combined mode is within {0:.0f} % "
                      "of the shortest finishing time and of the smallest RMS cross-track error, "
                      "and differential mode is within {0:.0f} % of the smallest speed drop",
                      percent),
      .why = fmt::format("on the waypoints, combined mode is {1}within {0:.0f} % of the best. On "
                         "the polyline, it is {2}within {0:.0f} % of the best. {3}Differential "
                         "mode {4}. These are single runs; `awmr compare` gives intervals",
                         percent, at_waypoints ? "" : "not ", along_line ? "" : "not ",
                         differential(&Metrics::cross_track_rms_m)
                             ? fmt::format("On both, differential mode is within {:.0f} % of the "
                                           "smallest RMS cross-track error. ",
                                           percent)
                             : "",
                         speed ? "holds the speed best"
                               : "does not hold the speed best: its wheel forces make the whole "
                                 "turn and reach their limits first")};
}

}  // namespace

std::vector<std::vector<Claim>> check_guidance_claims(std::span<const ClaimSetting> settings) {
  std::vector<std::vector<Claim>> claims(settings.size());
  const auto add = [&](const auto& claim, const auto&... runs) {
    for (std::size_t i = 0; i < claims.size(); ++i) claims[i].push_back(claim(runs[i]...));
  };
  const std::vector<ModeRuns> points = run_all(settings, paper_scenario("c8_waypoints"));
  add(waypoints_reached, points);
  add(line_followed, run_all(settings, paper_scenario("c9_line")));
  add(obstacles_avoided, run_all(settings, paper_scenario("c10_obstacle_on_line")),
      run_all(settings, paper_scenario("c10_obstacle_between_waypoints")));
  std::vector<OffPath> closed;
  for (const ModeRuns& runs : run_all(settings, paper_scenario("c11_lissajous_closed"))) {
    closed.push_back(off_path_by_mode(runs));
  }
  add(timed_path_followed, run_all(settings, paper_scenario("c11_lissajous")), closed);
  add(best_modes, points, run_all(settings, paper_scenario("c12_waypoints_and_line")));
  return claims;
}

}  // namespace awmr
