/// The numbers of a block of runs that are driven together, a lane each, and what the kernels do
/// with them. Plain data: the kernels are compiled for other instruction sets than the rest of the
/// program, and share no code with it.
#pragma once

#include "awmr/simulate/four_wheel_motion.h"
#include "awmr/simulate/meter.h"
#include "awmr/simulate/motion.h"
#include "awmr/simulate/run_controller.h"

namespace awmr {
namespace lanes {

/// Runs of a block, whatever the instruction set: two, four or eight steps of a kernel.
constexpr int kLanes = 16;

/// A number of each run.
struct alignas(64) Row {
  double lane[kLanes];
  Row() = default;
  explicit Row(double all) {
    for (double& one : lane) one = all;
  }
};

/// What the runs of a block have in common, over all of it.
struct BlockSetup {
  CombinedSplit split = CombinedSplit::kRedistribute;
  AllocationForm form = AllocationForm::kExact;
  bool is_open_loop = false;     ///< tau_speed and tau_turn stand in the block, and no law asks
  bool holds_tau_speed = false;  ///< tau_speed stands in the block, and the speed law is unused
  bool is_observed = false;      ///< by an observer of any run; bandwidth 0 where a run has none
  bool anti_windup = true;       ///< as in Observers
  bool is_lqi = false;           ///< the heading law; false: the sliding mode
  double sample_time_s = 0.0;
  MotorLag lag;
  bool is_by_wheel = false;   ///< each wheel has a force of its own
  bool has_back_emf = false;  ///< a vehicle of the block, or what its controller knows of it
  bool has_scrub = false;     ///< a vehicle of the block
  MeteredCourse course;       ///< with what says whether the block is on tyres
  Tyres<double> tyres;        ///< of a block on tyres
};

/// What they have in common over one sample.
struct BlockSample {
  MeteredTime time;
  bool has_battery = false;
  double battery_sag = 0.0;    ///< Battery::sag
  double battery_share = 1.0;  ///< of the largest force
  bool is_loaded = false;      ///< as in Push
  bool is_sloped = false;
  double slope_accel_mps2 = 0.0;
  double slope_downhill_rad = 0.0;
};

struct Block {
  BlockSetup setup;
  BlockSample sample;

  Row active;  ///< 1; 0 once the run has ended, or where the lane has none

  // Constant over a run.
  Row steering_share;  ///< YawSplit of its mode
  Plant<Row> plant;    ///< with its chord at rest
  Row step_s;          ///< h
  Row substeps;
  PreparedController<Row> controller;
  DisturbanceObserver<Row> yaw_observer, surge_observer;
  LqiGains<Row> lqi;
  Row dead_zone;   ///< F'0, as the controller knows it
  Row back_emf;    ///< k_e, as the controller knows it
  Row force_most;  ///< F' of a wheel at the most, with the zone
  MeteredVehicle<Row> metered;

  // As a run goes on.
  State<Row> state;
  ObserversState<Row> observed;
  LqiState<Row> lqi_state;
  SideForces<Row> motors;
  Row halves;  ///< see Resolution
  MeterSums<Row> sums;

  // Of the present sample: measurements, references and commands of the controller.
  Measurement<Row> measured;
  Reference<Row> reference;
  Row tau_speed, tau_turn_m;
  SideForces<Row> force;
  Row steering_command_rad;
  // What of it arrives at the ground, by side or by wheel.
  SideForces<Row> arriving;
  WheelForces<Row> wheels;
  BodyLoadOf<Row> load;
  // Inputs of the meter.
  Row goal_rad, cross_track_m, off_target_m, clearance_m;
};

/// The three steps of a sample, in this order, for one instruction set.
struct Kernel {
  const char* name;
  /// From `measured` and `reference` to the commands.
  void (*control)(Block& block);
  /// Takes the sample into the sums of the active lanes.
  void (*measure)(Block& block);
  /// From `force` to `arriving`, through motors and battery.
  void (*drive)(Block& block);
  /// Moves the states of the active lanes on; a lane that no step can follow, or whose numbers are no
  /// longer finite, stays, and is no longer active.
  void (*move)(Block& block);
};

}  // namespace lanes
}  // namespace awmr
