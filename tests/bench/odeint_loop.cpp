// Hand-written closed loop with Boost.odeint's runge_kutta4 and the same model, laws and metrics,
// one run after the other, with the same steps as `awmr compare`. scripts/bench compares batches
// with it.
// usage: odeint_loop MODEL.json GAINS.json SCENARIO.json SAMPLES
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cstdio>
#include <cstdlib>

#include "awmr/control/control_step.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/rest.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/simulate/scenario_file.h"
#include "closed_loop.h"

namespace {

using namespace awmr;
using Numbers = std::array<double, 7>;

State<double> state_of(const Numbers& x) { return {x[0], x[1], x[2], x[3], x[4], x[5], x[6]}; }

/// Executes a run of the heading scenario and returns its metrics.
Metrics driven(Plant<double> plant, const Controller<double>& controller, const Scenario& scenario,
               YawMode mode, double sample_time_s) {
  const int substeps = substeps_for(plant, sample_time_s);
  const double step_s = sample_time_s / substeps;
  plant = resolved_at_rest(plant, step_s);
  boost::numeric::odeint::runge_kutta4<Numbers> stepper;
  const auto command = [&](const Measurement<double>& measured, const Reference<double>& wanted) {
    return control_step(controller, mode, measured, wanted).allocation;
  };
  const auto move = [&](double t_s, const Allocation<double>& a, State<double>& s) {
    const auto system = [&](const Numbers& at, Numbers& rates, double) {
      const State<double> d = state_rates(plant, state_of(at), a.force, a.steering_rad);
      rates = {d.x_m, d.y_m, d.psi_rad, d.u_mps, d.v_mps, d.r_radps, d.steering_rad};
    };
    Numbers x{s.x_m, s.y_m, s.psi_rad, s.u_mps, s.v_mps, s.r_radps, s.steering_rad};
    for (int i = 0; i < substeps; ++i) stepper.do_step(system, x, t_s + i * step_s, step_s);
    s = state_of(x);
  };
  const auto sums = bench::driven<double>(scenario, sample_time_s, controller.yaw,
                                          metered_vehicle(controller.limits), command, move);
  return metrics_of(sums, {RunEnd::kDuration, scenario.duration_s, 0}, scenario);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto model = read_model(argv[1]);
  const auto gains = read_gains(argv[2]);
  const auto scenario = read_scenario(argv[3]);
  if (!model || !gains || !scenario) return 2;
  const auto nominal = model->plant();
  const auto sampler = PlantSampler::make(*model);
  if (!nominal || !sampler) return 2;
  const auto controller = make_controller(*nominal, model->vehicle, *gains);
  double sum = 0.0;
  for (int sample = 0; sample <= std::atoi(argv[4]); ++sample) {
    const auto plant = sample == 0 ? nominal : sampler->draw(1, sample);
    for (const YawMode mode : kYawModes) {
      sum +=
          driven(*plant, controller, *scenario, mode, model->vehicle.sample_time_s).path_length_m;
    }
  }
  std::printf("%.17g\n", sum);
}
