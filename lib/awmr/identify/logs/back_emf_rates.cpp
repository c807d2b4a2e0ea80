#include "awmr/identify/logs/back_emf_rates.h"

#include <array>
#include <cstddef>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// Vector of three numbers, one each for u, v and r; or a row of a 3 x 3 matrix.
using Vector3 = std::array<double, 3>;

/// Adds share times a b^T to the matrix `to`.
void add_product(double share, const Vector3& a, const Vector3& b, std::array<Vector3, 3>& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) to[i][j] += share * a[i] * b[j];
  }
}

/// Damping matrix D of back-EMF. A wheel rolls at the speed w = J (u, v, r), with the 1 x 3 matrix
/// J. Its force F' acts on the vehicle as (X, Y, N) = J^T F'. Back-EMF reduces F' by k_e w, so
///
///     (X, Y, N) -= k_e D (u, v, r),   D = sum J^T J over the wheels whose motor is on
///     J_rear = (1, 0, -+d),   J_front = (cos d_r, sin d_r, l_f sin d_r -+ d cos d_r)
///
/// The upper sign is for left wheels, the lower for right wheels. d: half of the track width; l_f:
/// distance of the front axle ahead of the centre of gravity; d_r: steering angle.
struct Braking {
  std::array<Vector3, 3> by_motion{};    ///< D
  std::array<Vector3, 3> by_steering{};  ///< d D / d d_r
};

void add_side(const Plant<double>& p, double left_m, double sin_d, double cos_d, Braking& braking) {
  const Vector3 rear{1.0, 0.0, -left_m};
  const Vector3 front{cos_d, sin_d, p.front_axle_m * sin_d - left_m * cos_d};
  const Vector3 turned{-sin_d, cos_d, p.front_axle_m * cos_d + left_m * sin_d};
  add_product(p.rear_driven, rear, rear, braking.by_motion);
  add_product(1.0, front, front, braking.by_motion);
  add_product(1.0, turned, front, braking.by_steering);
  add_product(1.0, front, turned, braking.by_steering);
}

}  // namespace

void add_back_emf(const LinearPlant& plant, const State<double>& s, bool left_on, bool right_on,
                  double sin_d, double cos_d, LinearRates& out) {
  const Plant<double>& p = plant.plant;
  Braking braking;
  if (left_on) add_side(p, p.half_track_m, sin_d, cos_d, braking);
  if (right_on) add_side(p, -p.half_track_m, sin_d, cos_d, braking);
  const Vector3 motion{s.u_mps, s.v_mps, s.r_radps};
  const Vector3 per_inertia{plant.per_mass, plant.per_mass, plant.per_inertia};
  const auto along = [&](const std::array<Vector3, 3>& matrix, std::size_t row) {
    return per_inertia[row] *
           (matrix[row][0] * motion[0] + matrix[row][1] * motion[1] + matrix[row][2] * motion[2]);
  };
  const Vector3 rate{along(braking.by_motion, 0), along(braking.by_motion, 1),
                     along(braking.by_motion, 2)};
  const double k = p.back_emf_s_per_m;
  auto& by = out.by_parameter;
  by[at(ParameterId::kBackEmf)] = {.u = -rate[0], .v = -rate[1], .r = -rate[2]};
  by[at(ParameterId::kMassNorm)].u += k * rate[0] * plant.per_mass;
  by[at(ParameterId::kMassNorm)].v += k * rate[1] * plant.per_mass;
  by[at(ParameterId::kInertiaNorm)].r += k * rate[2] * plant.per_inertia;
  out.rates.u_mps -= k * rate[0];
  out.rates.v_mps -= k * rate[1];
  out.rates.r_radps -= k * rate[2];
  StateSlopes& a = out.by_state;
  const auto slope = [&](std::size_t i, std::size_t j) {
    return k * per_inertia[i] * braking.by_motion[i][j];
  };
  a.u_u -= slope(0, 0);
  a.u_v -= slope(0, 1);
  a.u_r -= slope(0, 2);
  a.v_u -= slope(1, 0);
  a.v_v -= slope(1, 1);
  a.v_r -= slope(1, 2);
  a.r_u -= slope(2, 0);
  a.r_v = -slope(2, 1);
  a.r_r -= slope(2, 2);
  a.u_steering -= k * along(braking.by_steering, 0);
  a.v_steering -= k * along(braking.by_steering, 1);
  a.r_steering -= k * along(braking.by_steering, 2);
}

}  // namespace awmr
