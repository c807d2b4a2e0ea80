/// A model's quantities in newtons, newton metres and kilograms, as far as m' is known.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// A quantity of the model that the equations of motion divide by F_max, multiplied by it again.
struct SiQuantity {
  std::string pointer;  ///< below /si of model.json: "/surge/alpha", "/max_wheel_force"
  std::string name;     ///< in words for tables: "surge.alpha", "F_max"
  std::string unit;     ///< "N", "N m (s/rad)^b3", "kg m^2"
  Estimate estimate;    ///< always with a value
};

/// F_max, the mass, the yaw inertia and every resistance of the model; empty where m' has no value.
/// The mass of the vehicle is taken as exact, and with it
///   F_max = m/m'                                                                      [paper (66)]
///   Q     = p F_max = p m/m'      of each quantity p over F_max
/// The covariance of p and m' is carried over: with the gradient (m/m', -p m/m'^2),
///   Var Q = (m/m')^2 (C_pp - 2 (p/m') C_pm' + (p/m')^2 C_m'm')
/// so that Iz, from which I'z = m' Iz/m was made, is exact again. The interval takes the wider of
/// the quantiles that those of p and m' were made with. No standard error where one of the two was
/// not given and the model has no covariance of it.
///
/// F_max is the force of one of four wheels: where one motor drives both wheels of a side, it gives
/// twice as much.
std::vector<SiQuantity> si_quantities(const Model& model);

}  // namespace awmr
