/// A line by whichever law the scenario names, as a part of the guidance (control/guidance). Private to
/// this folder.
#pragma once

#include "awmr/control/guidance/ilos.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// LineFollower of any law.
struct CourseFollower {
  struct Corners {
    const Position<double>* points_m;
    int count;  ///< 0: there is no line
  } line;
  PolylineProgress<double> progress;
  bool is_started;
  const LineCourse* course;  ///< not owned
  double sample_time_s;
  CrossTrackIntegral<double> integral;
  PolylineGuidance<double> guided;  ///< of the last step
};

/// Reference of the line at one sample; call it once per sample.
PolylineGuidance<double> guide_line(CourseFollower& part, const Position<double>& position_m,
                                    double sideslip_rad);

}  // namespace awmr
