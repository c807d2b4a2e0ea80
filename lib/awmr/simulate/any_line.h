/// Follows a line in the simulator, where the scenario selects the guidance law at run time. (In a
/// firmware, the law is selected when it is compiled.)
#pragma once

#include <variant>

#include "awmr/control/guidance/parts.h"

namespace awmr {

/// Follows a line like LineFollower (guidance/parts.h), with any guidance law of LineLaws.
template <class T>
struct AnyLineFollower {
  struct Route {
    const Position<T>* points_m;
    int count;  ///< number of points; 0: no line
    T corner_m;
    LineLaws<std::variant, T> law;
  } line;
  T sample_time_s;
  PolylineProgress<T> progress;
  bool is_started;
  PolylineGuidance<T> guided;  ///< output of the last step

  void disable() { line.count = 0; }
  bool needs_position() const { return line.count > 0; }
};

template <class T>
PolylineGuidance<T> guide_line(AnyLineFollower<T>& part, const Position<T>& position_m,
                               const LineMotion<T>& motion) {
  const auto by = [&]<class Law>(const Law& law) {
    const Polyline<T, Law> line{part.line.points_m, part.line.count, part.line.corner_m, law};
    return guide(line, position_m, motion, part.progress);
  };
  part.guided = std::visit(by, part.line.law);
  return part.guided;
}

}  // namespace awmr
