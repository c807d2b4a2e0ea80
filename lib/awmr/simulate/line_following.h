/// A line by whichever law the scenario names. Private to this folder.
#pragma once

#include "awmr/control/guidance_ilos.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/sensing.h"

namespace awmr {

/// What following a line remembers from sample to sample, whatever the law.
struct LineProgress {
  PolylineProgress<double> along;
  CrossTrackIntegral<double> integral = start_integral<double>();
};

/// Where the line leads at one sample; to be asked once per sample.
PolylineGuidance<double> follow_line(const LineCourse& course, const Sensed& sensed,
                                     double sample_time_s, LineProgress& progress);

}  // namespace awmr
