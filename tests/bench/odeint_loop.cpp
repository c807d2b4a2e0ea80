// The closed loop of awmr with another integrator: Boost.odeint's runge_kutta4, one run after the
// other, with the plants, random numbers and step lengths of `awmr compare`. Sensors, guidance,
// control laws, step control and metrics are those of awmr. Prints the sum of all path lengths in
// m. scripts/bench compares batches with it.
// usage: odeint_loop MODEL.json GAINS.json SCENARIO.json SAMPLES
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cstdio>
#include <cstdlib>

#include "awmr/compare/comparison_inputs.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/closed_loop.h"
#include "awmr/simulate/scenario_file.h"

namespace {

using namespace awmr;
using Numbers = std::array<double, 7>;

State<double> to_state(const Numbers& x) { return {x[0], x[1], x[2], x[3], x[4], x[5], x[6]}; }

/// Stepper for steps::move().
struct OdeintStepper {
  template <class Rates>
  State<double> operator()(const State<double>& from, double h, const Rates& rates) const {
    boost::numeric::odeint::runge_kutta4<Numbers> stepper;
    const auto system = [&](const Numbers& at, Numbers& to, double) {
      const State<double> d = rates(to_state(at));
      to = {d.x_m, d.y_m, d.psi_rad, d.u_mps, d.v_mps, d.r_radps, d.steering_rad};
    };
    Numbers x{from.x_m,   from.y_m,     from.psi_rad,     from.u_mps,
              from.v_mps, from.r_radps, from.steering_rad};
    stepper.do_step(system, x, 0.0, h);
    return to_state(x);
  }
};

constexpr LoopSteps<double> kOdeintSteps = {
    "odeint",
    kOneRunSteps.control,
    kOneRunSteps.measure,
    {kOneVehicleSteps.dissipate, kOneVehicleSteps.actuate,
     [](Vehicles<double>& v) { steps::move(OneRun{}, v, OdeintStepper{}); }}};

/// Path length of a run, m.
double driven_m(const BatchRun& run, const Scenario& scenario, double sample_time_s) {
  ClosedLoop<double> loop({&run, 1}, scenario, kOdeintSteps,
                          {.sample_time_s = sample_time_s,
                           .samples = samples_in(scenario.duration_s, sample_time_s),
                           .has_metrics = true});
  loop.drive();
  return loop.metrics(0).value().path_length_m;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto model = read_model(argv[1]);
  const auto gains = read_gains(argv[2]);
  const auto scenario = read_scenario(argv[3]);
  if (!model || !gains || !scenario) return 2;
  CompareOptions options;
  options.samples = std::atoi(argv[4]);
  const auto plants = sample_plants(*model, {*scenario}, options);
  if (!plants) return 2;
  const double sample_time_s = model->vehicle.sample_time_s;
  const auto controller = make_controller(plants->nominal, model->vehicle, *gains);
  double sum_m = 0.0;
  for (std::size_t sample = 0; sample <= static_cast<std::size_t>(options.samples); ++sample) {
    const std::uint64_t seed = sample == 0 ? 0 : options.seed;
    const DrawnNoise noise = draw_sensor_noise(*scenario, sample_time_s, seed, sample);
    for (const YawMode mode : yaw_modes(model->vehicle)) {
      const BatchRun run{plants->vehicle(0, sample), controller, mode, seed, sample, &noise};
      sum_m += driven_m(run, *scenario, sample_time_s);
    }
  }
  std::printf("%.17g\n", sum_m);
}
