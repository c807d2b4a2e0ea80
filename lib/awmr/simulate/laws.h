/// The heading and speed laws of one run, and what its scenario makes of them. Private to this
/// folder.
#pragma once

#include <optional>

#include "awmr/control/controller.h"
#include "awmr/control/disturbance_observer.h"
#include "awmr/control/heading_lqi.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

class Laws {
 public:
  /// `start` is what the sensors say at t = 0.
  Laws(const Controller<double>& controller, const Scenario& scenario, YawMode mode,
       double sample_time_s, const Measurement<double>& start);

  Command<double> open_loop(const OpenLoop& open) const;
  /// To be asked once per sample, in order.
  Command<double> follow(const Measurement<double>& m, const Reference<double>& reference);

 private:
  ObservedMotion<double> motion_of(const Measurement<double>& m) const;
  void reallocate(const Measurement<double>& m, Command<double>& command) const;
  GeneralisedForces<double> made_of(const Command<double>& command) const;
  void take_off_disturbance(const Measurement<double>& m, Command<double>& command);

  Controller<double> controller_;
  YawMode mode_;
  std::optional<double> held_tau_speed_;  ///< in place of the speed law
  double sample_time_s_;
  std::optional<Observers<double>> observers_;
  ObserversState<double> observed_{};
  std::optional<LqiGains<double>> lqi_;  ///< absent: the heading law is the sliding mode
  LqiState<double> lqi_state_{};
};

}  // namespace awmr
