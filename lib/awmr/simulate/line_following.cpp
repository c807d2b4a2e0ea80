#include "awmr/simulate/line_following.h"

namespace awmr {
namespace {

/// The step of a run in which a line is followed.
struct LineStep {
  const LineCourse& course;
  const Position<double>& position_m;
  double sideslip;
  double sample_time_s;
  LineProgress& progress;

  int count() const { return static_cast<int>(course.points_m.size()); }

  PolylineGuidance<double> operator()(const LineLaw<double>& law) const {
    const Polyline<double> line{course.points_m.data(), count(), course.corner_m, law};
    return guide(line, position_m, sideslip, progress.along);
  }
  PolylineGuidance<double> operator()(const IntegralLos<double>& law) const {
    const Polyline<double, IntegralLos<double>> line{course.points_m.data(), count(),
                                                     course.corner_m, law};
    return guide(line, position_m, sideslip, sample_time_s, progress.along, progress.integral);
  }
  PolylineGuidance<double> operator()(const PurePursuit<double>& law) const {
    const PursuedLine<double> line{course.points_m.data(), count(), law};
    return guide(line, position_m, sideslip, progress.along);
  }
};

}  // namespace

PolylineGuidance<double> follow_line(const LineCourse& course, const Sensed& sensed,
                                     double sample_time_s, LineProgress& progress) {
  const double sideslip = sideslip_rad(sensed.motion.u_mps, sensed.motion.v_mps);
  return std::visit(LineStep{course, sensed.position_m, sideslip, sample_time_s, progress},
                    course.law);
}

}  // namespace awmr
