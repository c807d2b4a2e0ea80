// Checks of the claims C8 to C12: waypoints, line, obstacles, timed path, best modes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "awmr/core/units.h"
#include "awmr/validate/heading_runs.h"
#include "awmr/validate/paper_scenarios.h"

namespace awmr {
namespace {

/// Criterion for the claim that the distance d from the line tends to 0: largest |d| in the last
/// quarter of the run, as a fraction of the lane's half width.
constexpr double kOnTheLineShare = 0.01;
/// Criterion for the claim that the modes avoid obstacles alike: the longest finishing time of a
/// mode exceeds the shortest by at most this fraction.
constexpr double kAlikeShare = 0.10;
/// Criterion for the claim that the timed path is followed: largest distance from the moving point
/// of the path. It is a twentieth of the path's width of 20 m; less is hardly visible in a printed
/// figure.
constexpr double kPathTolerance_m = 1.0;
/// A value counts as equal to the best one if it is at most this fraction larger.
constexpr double kAsGoodShare = 0.01;

double largest_steering_deg(const ModeRun& run) {
  double largest = 0.0;
  for (const RunRow& row : run.run.rows) {
    largest =
        std::max({largest, std::abs(row.state.steering_rad), std::abs(row.steering_command_rad)});
  }
  return degrees(largest);
}

std::optional<double> finish_s(const ModeRun& run) { return run.metrics.finish_time_s; }
std::optional<double> cross_track_m(const ModeRun& run) { return run.metrics.cross_track_rms_m; }
std::optional<double> path_m(const ModeRun& run) { return run.metrics.path_length_m; }
std::optional<double> clearance(const ModeRun& run) { return run.metrics.clearance_min_m; }
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
  const auto steering = [](const ModeRun& run) -> std::optional<double> {
    return largest_steering_deg(run);
  };
  constexpr double kStop_deg = 20.0;  // the paper's steering stop [paper 5.1]
  const auto within = [&](const ModeRun& run) { return *steering(run) <= kStop_deg + 1e-9; };
  const bool reached = all_modes(runs, completed);
  const bool all_within = all_modes(runs, within);
  Claim claim{.id = "C8",
              .statement = "line of sight over E, F, G, H: all reached, |d_r| at most 20 deg",
              .reproduced = reached && all_within,
              .figure = fmt::format("all reached after {}; largest |d_r| {}; path length {}",
                                    by_mode(runs, "s", finish_s), by_mode(runs, "deg", steering),
                                    by_mode(runs, "m", path_m)),
              .tolerance = "each within 1 m (the paper prints no radius); d_r at most 20 deg",
              .why = {},
              .modes = verdicts_by_mode(
                  runs, [&](const ModeRun& run) { return completed(run) && within(run); })};
  claim.why = !reached ? "not all reached in 180 s: " + modes_without(runs, completed) +
                             " turns too wide for the acceptance radius"
              : !all_within ? "the front wheels of this vehicle turn further than 20 deg"
                            : "each turn fits between the points, and the allocation clips d_r at "
                              "its stop; the longest path is in the mode with the widest turns, in "
                              "the paper in combined mode";
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
  const Scenario scenario = line_scenario();
  const auto& law = std::get<LineOfSight<double>>(std::get<LinePath>(scenario.guidance).law);
  const double accepted_m = kOnTheLineShare * law.width_m;
  const auto off = [](const ModeRun& run) -> std::optional<double> {
    return final_cross_track_m(run);
  };
  const auto on_it = [&](const ModeRun& run) { return completed(run) && *off(run) <= accepted_m; };
  const bool all_on_it = all_modes(runs, on_it);
  return {.id = "C9",
          .statement = "line following: the distance from the line tends to 0",
          .reproduced = all_on_it,
          .figure = "largest distance in the last quarter, from 8.9 m at the start: " +
                    by_mode(runs, "m", off),
          .tolerance = fmt::format("{} m, a hundredth of the lane's half width, and the end of the "
                                   "line passed",
                                   accepted_m),
          .why = all_on_it ? "with beta subtracted, d_dot = -U sin(Delta sat(d/R)) [paper (113)] "
                             "as soon as the heading follows"
                           : "the heading does not follow its reference closely enough in " +
                                 modes_without(runs, on_it),
          .modes = verdicts_by_mode(runs, on_it)};
}

bool alike(const ModeRuns& runs) {
  double least = 1e300;
  double most = 0.0;
  for (const ModeRun& run : runs) {
    least = std::min(least, finish_s(run).value_or(0.0));
    most = std::max(most, finish_s(run).value_or(1e300));
  }
  return most <= (1.0 + kAlikeShare) * least;
}

Claim obstacles_avoided(const ModeRuns& line, const ModeRuns& points) {
  const bool avoided = all_modes(line, completed) && all_modes(points, completed);
  const bool same = alike(line) && alike(points);
  const auto figure = [](const ModeRuns& runs) {
    return fmt::format("least clearance {}, finished after {}", by_mode(runs, "m", clearance),
                       by_mode(runs, "s", finish_s));
  };
  return {.id = "C10",
          .statement =
              "obstacles are avoided alike by the three modes, on a line and between "
              "waypoints",
          .reproduced = avoided && same,
          .figure = "on a line: " + figure(line) + "; between waypoints: " + figure(points),
          .tolerance = fmt::format("clearance above 0 and the path completed in every mode; "
                                   "finishing times within {:.0f} % of each other",
                                   100.0 * kAlikeShare),
          .why = !avoided ? "at least one mode does not complete its path"
                 : !same  ? "all modes avoid the obstacles, but one turns wider and takes longer"
                          : "the minimum manoeuvring distance is chosen for the widest turn, so "
                            "every mode has room; the avoidance rule is the project's own, because "
                            "the figure with the paper's rule is lost"};
}

/// Largest distance of the vehicle from the point of the path at the same time, m.
double off_path_m(const ModeRun& run) {
  double largest = 0.0;
  for (const RunRow& row : run.run.rows) {
    largest = std::max(largest, distance_m(row.path.target_m, {row.state.x_m, row.state.y_m}));
  }
  return largest;
}

/// Smallest radius of curvature of the path p(t), m: |p_dot|^3/|p_dot x p_ddot|, which is the speed
/// divided by the yaw rate.
double least_radius_m(const Lissajous<double>& path, double duration_s) {
  double least = 1e300;
  for (double t_s = 0.0; t_s < duration_s; t_s += 0.1) {
    const PathGuidance<double> at = open_path(path.at(t_s), 0.0);
    least = std::min(least, at.speed_mps / std::max(std::abs(at.psi_rate_radps), 1e-12));
  }
  return least;
}

/// Results of off_path_m() by mode, which are kept instead of the runs to save memory.
using OffPath = std::map<YawMode, double>;
OffPath off_path_by_mode(const ModeRuns& runs) {
  OffPath off;
  for (const ModeRun& run : runs) off[run.mode] = off_path_m(run);
  return off;
}

Claim timed_path_followed(const ModeRuns& open, const OffPath& closed_off_m) {
  const Scenario open_scenario = lissajous_scenario(false);
  OffPath off_m = off_path_by_mode(open);
  const auto off = [&](const ModeRun& run) -> std::optional<double> { return off_m[run.mode]; };
  const auto closed_off = [&](const ModeRun& run) -> std::optional<double> {
    return closed_off_m.at(run.mode);
  };
  const auto followed = [&](const ModeRun& run) { return *off(run) <= kPathTolerance_m; };
  const bool all = all_modes(open, followed);
  const double radius_m = least_radius_m(std::get<LissajousPath>(open_scenario.guidance).path,
                                         open_scenario.duration_s);
  const std::string slow = modes_without(open, followed);
  return {.id = "C11",
          .statement = "the Lissajous path x = 10 cos 0.01t, y = 10 sin 0.03t is followed",
          .reproduced = all,
          .figure = fmt::format("largest distance from the point of the path, heading alone (the "
                                "paper's form): {}; with position feedback: {}",
                                by_mode(open, "m", off), by_mode(open, "m", closed_off)),
          .tolerance = fmt::format("{} m in every mode with the paper's form, a twentieth of the "
                                   "path's width",
                                   kPathTolerance_m),
          .why = all ? "no turn of the path is tighter than the modes can make; nothing disturbs "
                       "the open form here"
                     : fmt::format("the path turns with a radius down to {:.2f} m, too tight for "
                                   "{}; without position feedback, a position error remains",
                                   radius_m, slow),
          .modes = verdicts_by_mode(open, followed)};
}

/// Largest drop of the speed below u_d after u_d was first reached, m/s.
std::optional<double> drop_mps(const ModeRun& run) { return run.metrics.speed_drop_mps; }

/// True if `mode` has the smallest value or is within kAsGoodShare of it.
template <class Value>
bool is_best(const ModeRuns& runs, YawMode mode, Value value) {
  const auto own = value(in_mode(runs, mode));
  if (!own) return false;
  return all_modes(runs, [&](const ModeRun& run) {
    const auto other = value(run);
    return !other || *own <= (1.0 + kAsGoodShare) * *other;
  });
}

Claim best_modes(const ModeRuns& points, const ModeRuns& path) {
  const auto best_for = [](const ModeRuns& runs, YawMode mode) {
    return is_best(runs, mode, finish_s) && is_best(runs, mode, cross_track_m);
  };
  const YawMode combined = YawMode::kCombined;
  const bool at_waypoints = best_for(points, combined), along_line = best_for(path, combined);
  const bool speed = is_best(points, YawMode::kDifferential, drop_mps) &&
                     is_best(path, YawMode::kDifferential, drop_mps);
  const auto figure = [](const ModeRuns& runs) {
    return fmt::format("finished after {}, cross-track RMS {}, speed drop {}",
                       by_mode(runs, "s", finish_s), by_mode(runs, "m", cross_track_m),
                       by_mode(runs, "m/s", drop_mps));
  };
  const auto place = [](bool best) {
    return fmt::format("{} {:.0f} % of the best", best ? "within" : "not within",
                       100.0 * kAsGoodShare);
  };
  const bool differential_close = is_best(points, YawMode::kDifferential, cross_track_m) &&
                                  is_best(path, YawMode::kDifferential, cross_track_m);
  return {
      .id = "C12",
      .statement = "combined is best for waypoints and paths, differential for speed",
      .reproduced = at_waypoints && along_line && speed,
      .figure = "waypoints: " + figure(points) + "; polyline: " + figure(path),
      .tolerance = fmt::format("combined within {0:.0f} % of the least finishing time and "
                               "cross-track RMS on both paths, differential within {0:.0f} % "
                               "of the least speed drop on both",
                               100.0 * kAsGoodShare),
      .why = fmt::format(
          "combined is {} on waypoints and {} on the polyline{}; differential is {} for the "
          "speed. `awmr compare` gives intervals",
          place(at_waypoints), place(along_line),
          differential_close ? "; differential is close to the least cross-track RMS on both" : "",
          speed ? "best" : "not best: its forces make the whole turn and saturate first")};
}

}  // namespace

std::vector<std::vector<Claim>> check_guidance_claims(std::span<const ClaimSetting> settings) {
  std::vector<std::vector<Claim>> claims(settings.size());
  const auto add = [&](const auto& claim, const auto&... runs) {
    for (std::size_t i = 0; i < claims.size(); ++i) claims[i].push_back(claim(runs[i]...));
  };
  const std::vector<ModeRuns> points = run_all(settings, waypoint_scenario());
  add(waypoints_reached, points);
  add(line_followed, run_all(settings, line_scenario()));
  add(obstacles_avoided, run_all(settings, obstacle_on_line_scenario()),
      run_all(settings, obstacle_between_waypoints_scenario()));
  std::vector<OffPath> closed;
  for (const ModeRuns& runs : run_all(settings, lissajous_scenario(true))) {
    closed.push_back(off_path_by_mode(runs));
  }
  add(timed_path_followed, run_all(settings, lissajous_scenario(false)), closed);
  add(best_modes, points, run_all(settings, polyline_scenario()));
  return claims;
}

}  // namespace awmr
