#include "awmr/model/wheel_force_json.h"

namespace awmr {

Interval wheel_force_from_json(JsonObject json) {
  Interval force;
  // F' is relative to the largest force of one motor, so it is within [-1, 1]. The range must
  // include 0 (motors off) and forward forces.
  force.lo = json.number("min", {.min = -1.0, .max = 0.0});
  force.hi = json.number("max", {.min = 0.0, .max = 1.0, .min_excluded = true});
  json.reject_unknown_keys();
  return force;
}

Json wheel_force_to_json(const Interval& force) { return {{"min", force.lo}, {"max", force.hi}}; }

}  // namespace awmr
