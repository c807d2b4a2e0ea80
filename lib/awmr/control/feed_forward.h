/// Resistance that the heading and speed laws feed forward.
#pragma once

#include "awmr/control/resistance_table.h"
#include "awmr/model/resistance.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Resistance that a control law adds to its command at the speed w (u in the speed law, r in the
/// heading law):
///   g(w)                                        for |w| >= rest_speed
///   g(rest_speed) sat((w + intent)/rest_speed)  below
/// The second line is for resistances that jump at rest (feed_forward() in resistance.h). Near
/// rest, the sign of the measured w is noise. Therefore, this line takes the sign of the wanted
/// motion. `intent` is the error that the law corrects: the speed error e_u, or the sliding
/// variable S of the heading law. The sum w + intent is free of the noise of w: it is u_d in the
/// speed law, and psi_d_dot + lambda e in the heading law. (For u_d = 0, the speed law passes w =
/// 0. The sum is then -u, and friction helps to brake.)
template <class T>
T fed_forward(const Resistance<T>& law, const T& speed, const T& intent) {
  using math::abs;
  using math::all;
  using math::any;
  using math::select;
  const Mask<T> rests = abs(speed) < law.rest_speed;
  if (!any(rests)) return law(speed);
  const T held =
      law.at(law.rest_speed) * math::saturate(T((speed + intent) / law.rest_speed), T(1.0));
  if (MaskOf<T>::kOneLane || all(rests)) return held;
  return select(rests, held, law(speed));
}
/// Resistance that the law feeds forward, for a table whose resistance jumps at rest.
inline float fed_forward(const RestingTable& law, const float& speed, const float& intent) {
  if (!law.is_resting(speed)) return law.table(speed);
  return law.at_rest * math::saturate((speed + intent) / law.rest_speed, 1.0F);
}
/// Resistance g(w) that the law feeds forward, for a resistance that does not jump at rest.
template <class T, class G>
T fed_forward(const G& table, const T& speed, const T&) {
  return table(speed);
}

}  // namespace awmr
