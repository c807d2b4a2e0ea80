#include "awmr/report/live_numbers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/gains_json.h"
#include "awmr/report/live/setup.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

/// Reads the form of the constraint on T2: the paper's form T2 < T1 = 1/lambda, or the strict form
/// T2 < margin/lambda. gains.json has the limit of the strict form in both cases, from which the
/// margin is computed.
void take_reaching(JsonObject& gains, double lambda, ConstraintContext& context) {
  for (JsonObject& constraint : gains.optional_objects("constraints")) {
    const bool strict = constraint.string("name") == "T2 < T1 (strict)";
    const bool required = constraint.boolean("required");
    const double limit = constraint.number("limit");
    if (!strict) continue;
    context.form = required ? ReachingForm::kStrict : ReachingForm::kPaper;
    context.margin = limit * lambda;
  }
}

/// Number, seed and unmodelled variation of the vehicles that were drawn for the tuning.
struct Draws {
  int count = 0;
  std::uint64_t seed = 1;
  UnmodelledVariation open = {};
};

/// Reads into `context` the noise, latency and motor lag for which gains were tuned on drawn
/// vehicles. Returns how these vehicles were drawn.
Draws take_conditions(JsonObject robust, ConstraintContext& context) {
  JsonObject latency = robust.object("latency");
  const double latest_s = std::max(latency.number("heading_s", kNonNegative),
                                   latency.number("yaw_rate_s", kNonNegative));
  JsonObject noise = robust.object("noise");
  context.heading_noise_rad = radians(noise.number("heading_deg", kNonNegative));
  context.yaw_rate_noise_radps = radians(noise.number("yaw_rate_degps", kNonNegative));
  context.latency_s = latest_s;
  context.motor_time_constant_s = robust.number("motor_time_constant_s", kNonNegative);
  if (!(latest_s < (kMaxLatencySamples + 1e-9) * context.sample_time_s)) {
    robust.fault(ErrorCode::kTooLarge, "latency",
                 "is longer than 20 sample times, which awmr tune does not accept; tune again");
  }
  Draws draws{static_cast<int>(robust.integer("draws", 0, 1000)),
              static_cast<std::uint64_t>(robust.integer("seed", 0, 4'294'967'295L))};
  if (auto open = robust.optional_object("open", read_open)) draws.open = *std::move(open);
  return draws;
}

/// Reads the tuning conditions from gains.json. Errors (input): gains.json has another format.
Result<Draws> take_tuning(const Json& gains, LiveSetup& setup) {
  std::vector<Fault> faults;
  JsonObject json(gains, "gains.json", "", faults);
  const Gains<double> tuned = gains_from_json(json);
  setup.observer_yaw_max_m = tuned.observer.yaw_max_m;
  setup.observer_surge_max = tuned.observer.surge_max;
  if (json.has("mode")) setup.context.mode = json.choice("mode", kYawModeNames);
  // If the modes have gains of their own, the gains at the root are those of combined mode.
  if (json.has("modes")) setup.context.mode = YawMode::kCombined;
  take_reaching(json, tuned.heading.lambda, setup.context);
  if (auto limits = json.optional_object("limits", read_limits)) setup.context.limits = *limits;
  if (const auto range = json.optional_object("examined", read_examined)) {
    setup.context.speed_mps = range->speed_mps;
    setup.context.step_rad = range->step_rad;
    setup.context.fastest_radps = range->yaw_rate_radps;
  }
  Draws draws;
  if (auto robust = json.optional_object("robust")) draws = take_conditions(*robust, setup.context);
  if (!faults.empty()) return input_errors(std::move(faults));
  return draws;
}

}  // namespace

bool is_plain_heading(const Json& scenario) {
  constexpr std::array<std::string_view, 6> kPlain{"schema",  "name",      "duration_s",
                                                   "initial", "speed_mps", "guidance"};
  for (const auto& [key, value] : scenario.items()) {
    if (std::find(kPlain.begin(), kPlain.end(), key) == kPlain.end()) return false;
  }
  return scenario["guidance"].value("type", "") == "heading";
}

Result<std::vector<double>> live_numbers(const Model& model, const Json& gains,
                                         const Scenario& scenario) {
  if (model.simulated_motion() != Motion::kPlanar) return std::vector<double>{};
  LiveSetup setup;
  AWMR_ASSIGN_OR_RETURN(setup.context.plant, model.plant());
  setup.context.has_steering = model.vehicle.has_steering();
  setup.context.sample_time_s = model.vehicle.sample_time_s;
  setup.context.wheel_force = model.vehicle.wheel_force;
  setup.context.speed_mps = setup.speed_mps = scenario.speed_mps;
  AWMR_ASSIGN_OR_RETURN(const Draws draws, take_tuning(gains, setup));
  AWMR_ASSIGN_OR_RETURN(const std::vector<DrawnVehicle> vehicles,
                        vehicles_of(model, draws.count, draws.seed, draws.open, Spread::kEven));
  setup.context.draws.assign(vehicles.begin() + 1, vehicles.end());
  setup.allocation_form = static_cast<double>(model.vehicle.allocation);
  setup.duration_s = scenario.duration_s;
  setup.initial = scenario.initial;
  setup.steps = std::get<HeadingSteps>(scenario.guidance).steps;

  std::vector<double> numbers;
  visit_numbers(setup, [&](double x) { numbers.push_back(x); });
  return numbers;
}

}  // namespace awmr
