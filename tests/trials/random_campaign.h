/// Random realistic vehicles with tables of surge and turning runs, which no check may refuse. The
/// physics is not that of awmr's model, on purpose: a bicycle with slip, and differential drive
/// with tyre scrub.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "awmr/core/random.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

struct Campaign {
  Vehicle vehicle;
  std::string surge;    ///< table of surge runs, as written to a file
  std::string turning;  ///< yaw_rate_radps in the requested unit
};

/// Random properties of a vehicle that are not in vehicle.json.
struct DrawnVehicle {
  double top_speed_mps;  ///< at F' = 1
  double steepness;      ///< u ~ F'^steepness
  double wheelbase_m;
  double slows;               ///< fraction of the straight speed that remains in a turn
  double characteristic_mps;  ///< characteristic speed of understeer, u_ch
  double friction;            ///< friction coefficient of tyres on the ground
  double agility;             ///< factor on the yaw rate; above 1: oversteer, or rear steering
  double scrubs;              ///< fraction of the left/right speed difference left by scrub
};

class CampaignDraw {
 public:
  CampaignDraw(std::uint64_t seed, Drive drive, double rate_factor)
      : random_(seed, 0), rate_factor_(rate_factor) {
    made_.vehicle = vehicle(drive);
    drawn_ = behaviour();
    made_.surge = surge_table();
    made_.turning = drive == Drive::kDifferential ? side_table() : steered_table();
  }
  const Campaign& campaign() const { return made_; }
  const DrawnVehicle& drawn() const { return drawn_; }

 private:
  double between(double lo, double hi) { return lo + (hi - lo) * random_.uniform(); }
  double log_between(double lo, double hi) { return std::exp(between(std::log(lo), std::log(hi))); }
  double about(double value, double share) { return value * (1.0 + share * random_.normal()); }

  /// Draws a vehicle, from a model car of 17 cm to a field robot of 3 m.
  Vehicle vehicle(Drive drive) {
    Vehicle v = paper_vehicle();
    v.drive = drive;
    v.length_m = log_between(0.17, 3.0);
    v.width_m = v.length_m * between(0.5, 0.9);
    v.mass_kg = between(20.0, 80.0) * v.length_m * v.width_m;
    v.half_track_m = 0.5 * v.width_m * between(0.7, 0.95);
    wheelbase_m_ = v.length_m * between(0.5, 0.8);
    v.front_axle_m = wheelbase_m_ * between(0.35, 0.6);
    v.yaw_inertia_kgm2.reset();
    v.steering_max_deg = between(18.0, 35.0);
    if (drive == Drive::kDifferential) {
      v.steering_max_deg = v.steering_max_rate_degps = v.steering_time_constant_s = 0.0;
    }
    return v;
  }
  /// Draws the top speed: from a third of the vehicle's length per second to 30 lengths/s (a racing
  /// model car), at most 25 m/s; without steering up to 15 lengths/s, at most 8 m/s.
  DrawnVehicle behaviour() {
    const double length = made_.vehicle.length_m;
    const double top = made_.vehicle.has_steering()
                           ? std::min(25.0, length * log_between(0.3, 30.0))
                           : std::min(8.0, length * log_between(0.3, 15.0));
    const bool is_odd = random_.uniform() < 0.15;
    return {.top_speed_mps = top,
            .steepness = between(0.6, 2.0),
            .wheelbase_m = wheelbase_m_,
            .slows = between(0.4, 1.0),
            .characteristic_mps = std::sqrt(9.81 * wheelbase_m_) * log_between(0.7, 4.0),
            .friction = between(0.4, 1.1),
            .agility = is_odd ? between(1.0, 2.0) : 1.0,
            .scrubs = log_between(0.15, 0.9)};
  }
  double speed_mps(double force) const {
    const double size = drawn_.top_speed_mps * std::pow(std::abs(force), drawn_.steepness);
    return force < 0.0 ? -size : size;
  }
  std::string surge_table() {
    const bool is_timed = random_.uniform() < 0.5;
    std::string text = is_timed ? "wheel_force,distance_m,elapsed_s\n" : "wheel_force,speed_mps\n";
    const int runs = 5 + static_cast<int>(6.0 * random_.uniform());
    for (int i = 1; i <= runs; ++i) {
      const double force = 0.2 + 0.7 * i / runs;
      const double speed = about(speed_mps(force), 0.03);
      text += is_timed ? fmt::format("{:.3f},20,{:.2f}\n", force, 20.0 / speed)
                       : fmt::format("{:.3f},{:.4f}\n", force, speed);
    }
    return text;
  }
  /// Turns of a bicycle: r = u tan(d)/L / (1 + (u/u_ch)^2), limited by the tyres' grip, r u <= mu
  /// g.
  std::string steered_table() {
    std::string text = "steering_deg,wheel_force,yaw_rate_radps\n";
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      for (const double force : {0.35, 0.6}) {
        const double steering_deg = share * made_.vehicle.steering_max_deg;
        const double u = drawn_.slows * speed_mps(force);
        const double rolled =
            drawn_.agility * u * std::tan(radians(steering_deg)) / drawn_.wheelbase_m;
        const double ratio = u / drawn_.characteristic_mps;
        const double slips = rolled / (1.0 + ratio * ratio);
        const double rate = std::min(slips, drawn_.agility * drawn_.friction * 9.81 / u);
        text += fmt::format("{:.1f},{:.2f},{:.5g}\n", steering_deg, force,
                            rate_factor_ * about(rate, 0.05));
      }
    }
    return text;
  }
  /// Yaw rate of a differential turn: each side rolls as it would straight ahead, reduced by scrub.
  std::string side_table() {
    std::string text = "force_left,force_right,yaw_rate_radps\n";
    const std::pair<double, double> runs[] = {{-0.3, 0.3}, {-0.5, 0.5}, {-0.8, 0.8}, {0.2, 0.5},
                                              {0.3, 0.7},  {0.0, 0.6},  {0.1, 0.8},  {-0.2, 0.6}};
    for (const auto& [left, right] : runs) {
      const double rolled =
          (speed_mps(right) - speed_mps(left)) / (2.0 * made_.vehicle.half_track_m);
      const double rate = std::min(20.0, drawn_.scrubs * rolled);
      text += fmt::format("{},{},{:.5g}\n", left, right, rate_factor_ * about(rate, 0.05));
    }
    return text;
  }
  static double radians(double deg) { return deg * std::acos(-1.0) / 180.0; }

  Random random_;
  double rate_factor_;
  double wheelbase_m_ = 0.0;
  Campaign made_;
  DrawnVehicle drawn_{};
};

}  // namespace awmr::testing
