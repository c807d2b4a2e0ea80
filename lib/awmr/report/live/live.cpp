/// Interactive part of the report page, compiled to WebAssembly. It simulates one run and computes
/// the tuning constraints for the gains of the sliders. It is built from the same sources of
/// simulation and tuning as the command line.
///
/// The page writes the numbers of the setup to the array of live_setup() and calls live_begin().
/// For each position of the sliders, it calls live_run(). Then it reads live_rows() rows of
/// kColumns doubles at live_table(), and live_size() bytes of JSON at live_text().
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/report/live/setup.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {
namespace {

struct MetricOfRun {
  const char* name;
  std::optional<double> value;
};

std::vector<double> numbers;
LiveSetup setup;
std::vector<double> table;
std::string text;
/// Number of columns of `table`, the result of a run, which fill_table() writes.
constexpr std::size_t kColumns = 8;

Vehicle vehicle_of_setup(double sample_time_s) {
  Vehicle vehicle;
  vehicle.wheel_force = setup.context.wheel_force;
  vehicle.drive = setup.context.has_steering ? Drive::kFourWheel : Drive::kDifferential;
  vehicle.allocation = static_cast<AllocationForm>(static_cast<int>(setup.allocation_form));
  vehicle.sample_time_s = sample_time_s;
  return vehicle;
}

Scenario scenario_of_setup(double heading_noise_deg) {
  Scenario scenario{.name = "live",
                    .duration_s = setup.duration_s,
                    .initial = setup.initial,
                    .speed_mps = setup.speed_mps,
                    .guidance = HeadingSteps{setup.steps}};
  if (heading_noise_deg > 0.0) {
    scenario.sensors.emplace();
    scenario.sensors->heading.noise = radians(heading_noise_deg);
  }
  return scenario;
}

void fill_table(const Run& run) {
  table.clear();
  for (const RunRow& row : run.rows) {
    table.insert(table.end(),
                 {row.t_s, row.state.psi_rad, row.psi_ref_rad, row.state.u_mps, row.force.left,
                  row.force.right, row.state.steering_rad, row.state.r_radps});
  }
}

std::string metrics_text(const Metrics& m) {
  std::string json;
  for (const auto& [name, value] :
       std::initializer_list<MetricOfRun>{{"settling_time_s", m.settling_time_s},
                                          {"overshoot_deg", m.overshoot_deg},
                                          {"heading_iae_degs", m.heading_iae_degs},
                                          {"speed_drop_mps", m.speed_drop_mps},
                                          {"sideslip_max_deg", m.sideslip_max_deg},
                                          {"yaw_rate_max_degps", m.yaw_rate_max_degps},
                                          {"control_variation", m.control_variation},
                                          {"saturation_s", m.saturation_s}}) {
    json += fmt::format("{}\"{}\":{}", json.empty() ? "" : ",", name,
                        value ? fmt::format("{}", *value) : "null");
  }
  return json;
}

/// Text of a number; "null" for infinity and NaN, which JSON does not have.
std::string number(double x) { return x - x == 0.0 ? fmt::format("{}", x) : "null"; }

/// JSON of the constraints. Precondition: names and meanings have no quotes or backslashes.
std::string constraints_text(const std::vector<ConstraintReport>& constraints) {
  std::string json;
  for (const ConstraintReport& c : constraints) {
    json += fmt::format(
        "{}{{\"name\":\"{}\",\"value\":{},\"limit\":{},\"margin\":{},\"meaning\":\"{}\","
        "\"required\":{}}}",
        json.empty() ? "" : ",", c.name, number(c.value), number(c.limit), number(c.margin),
        c.meaning, c.required);
  }
  return json;
}

}  // namespace
}  // namespace awmr

using namespace awmr;

#define AWMR_EXPORT(name) extern "C" __attribute__((export_name(#name)))

/// Returns an array into which the page writes the `count` numbers of the setup.
AWMR_EXPORT(live_setup) double* live_setup(int count) {
  numbers.assign(static_cast<std::size_t>(count), 0.0);
  return numbers.data();
}

/// Reads the setup from the array of live_setup().
AWMR_EXPORT(live_begin) void live_begin() {
  std::size_t next = 0;
  visit_numbers(setup, [&](double& x) { x = numbers[next++]; });
}

/// Simulates one run and computes constraints and metrics. The arguments are the positions of the
/// sliders: the gains; observer_radps: bandwidth of the observer, rad/s, 0: no observer; mode: a
/// YawMode as a number; mass: factor on m' and I'z of the simulated vehicle; friction: factor on
/// its resistance coefficients a1 and a3. The controller keeps the model's values of m', I'z, a1
/// and a3. Returns false if the run diverges.
AWMR_EXPORT(live_run)
bool live_run(double lambda, double mu, double epsilon, double speed_mu, double speed_epsilon,
              double observer_radps, int mode, double sample_time_s, double mass, double friction,
              double heading_noise_deg) {
  ConstraintContext context = setup.context;
  context.sample_time_s = sample_time_s;
  const Gains<double> gains =
      with_friction_width({{lambda, mu, epsilon},
                           {speed_mu, speed_epsilon},
                           {observer_radps, setup.observer_yaw_max_m, setup.observer_surge_max}},
                          context);
  const Vehicle vehicle = vehicle_of_setup(sample_time_s);
  const Controller<double> controller = make_controller(context.plant, vehicle, gains);
  Plant<double> plant = context.plant;
  plant.mass_norm *= mass;
  plant.inertia_norm *= mass;
  plant.surge.alpha *= friction;
  plant.yaw.alpha *= friction;
  const Scenario scenario = scenario_of_setup(heading_noise_deg);
  const Run run = simulate(plant, controller, scenario, static_cast<YawMode>(mode),
                           {.sample_time_s = sample_time_s});
  fill_table(run);
  text = "{\"constraints\":[" + constraints_text(constraints_of(gains, context)) +
         "],\"metrics\":{" + metrics_text(metrics_of(run, scenario, controller)) + "}}";
  return run.end != RunEnd::kFailed;
}

AWMR_EXPORT(live_rows) int live_rows() { return static_cast<int>(table.size() / kColumns); }
AWMR_EXPORT(live_table) const double* live_table() { return table.data(); }
AWMR_EXPORT(live_text) const char* live_text() { return text.data(); }
AWMR_EXPORT(live_size) int live_size() { return static_cast<int>(text.size()); }
