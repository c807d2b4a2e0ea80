/// Converts the quantities of a model whose mass m' (divided by F_max) is known to newtons, newton
/// metres and kilograms.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// A quantity of the model in SI units: the normalised quantity times F_max.
struct SiQuantity {
  std::string pointer;  ///< below /si of model.json: "/surge/alpha", "/max_wheel_force"
  std::string name;     ///< name for tables: "surge.alpha", "F_max"
  std::string unit;     ///< "N", "N m (s/rad)^b3", "kg m^2"
  Estimate estimate;    ///< always with a value
};

/// Returns F_max, the mass, the yaw inertia, and each resistance, dead zone and back-EMF of the
/// model in SI units; empty if m' has no value. The mass of the vehicle is assumed exact, so
///   F_max = m/m'                                                                      [paper (66)]
///   Q     = p F_max = p m/m'      of each quantity p divided by F_max
/// The variance of Q follows from the covariances C of p and m'. With the derivatives of Q with
/// respect to p and m', which are m/m' and -p m/m'^2:
///   Var Q = (m/m')^2 (C_pp - 2 (p/m') C_pm' + (p/m')^2 C_m'm')
/// For p = I'z = m' Iz/m, the terms cancel, so that Iz is exact again. The half width of the
/// interval of Q, in standard errors, is the larger of the half widths for p and m'. Q has no
/// standard error if p or m' was estimated and is not in the model's covariance.
///
/// F_max is the largest force of one driven wheel: if one motor drives both wheels of a side, the
/// largest force of this motor is twice F_max.
std::vector<SiQuantity> si_quantities(const Model& model);

}  // namespace awmr
