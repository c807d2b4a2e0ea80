#include "awmr/simulate/line_following.h"

namespace awmr {
namespace {

/// The step of a run in which a line is followed.
struct LineStep {
  CourseFollower& part;
  const Position<double>& position_m;
  double sideslip_rad;

  PolylineGuidance<double> operator()(const LineLaw<double>& law) const {
    return guide(Polyline<double>{part.line.points_m, part.line.count, part.course->corner_m, law},
                 position_m, sideslip_rad, part.progress);
  }
  PolylineGuidance<double> operator()(const IntegralLos<double>& law) const {
    const Polyline<double, IntegralLos<double>> line{part.line.points_m, part.line.count,
                                                     part.course->corner_m, law};
    return guide(line, position_m, sideslip_rad, part.sample_time_s, part.progress, part.integral);
  }
  PolylineGuidance<double> operator()(const PurePursuit<double>& law) const {
    return guide(PursuedLine<double>{part.line.points_m, part.line.count, law}, position_m,
                 sideslip_rad, part.progress);
  }
};

}  // namespace

PolylineGuidance<double> guide_line(CourseFollower& part, const Position<double>& position_m,
                                    double sideslip_rad) {
  part.guided = std::visit(LineStep{part, position_m, sideslip_rad}, part.course->law);
  return part.guided;
}

}  // namespace awmr
