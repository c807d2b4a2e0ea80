#include "awmr/simulate/straight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace awmr {
namespace {

/// True if nothing in this row turns the vehicle or moves it sideways. Rounding errors, such as
/// those of sin(pi) or atan2, are tolerated. They have a larger effect than usual, because the
/// unknown resistances in yaw and sway are simulated as 0.
bool is_straight(const RunRow& row) {
  constexpr double kRounding = 1e-9;  // m/s, rad/s, rad, m
  const double turning[] = {row.state.v_mps,        row.state.r_radps,
                            row.state.steering_rad, row.steering_command_rad,
                            row.tau_turn_m,         row.force.right - row.force.left};
  return std::all_of(std::begin(turning), std::end(turning),
                     [](double number) { return std::abs(number) <= kRounding; });
}

}  // namespace

Status check_straight(const Run& run, const Scenario& scenario, const Model& model) {
  const auto turned = std::find_if_not(run.rows.begin(), run.rows.end(), is_straight);
  if (turned == run.rows.end()) return {};
  Error error = model.plant(Motion::kPlanar).error();
  error.faults.insert(
      error.faults.begin(),
      Fault{ErrorCode::kUnsupported, fmt::format("scenario '{}'", scenario.name),
            fmt::format("the run turns at {:g} s, but the model only has parameters for straight "
                        "motion; give a scenario without turns, or record the trials named below",
                        turned->t_s)});
  return tl::unexpected(std::move(error));
}

}  // namespace awmr
