#include <utility>

#include "awmr/simulate/any_line.h"
#include "executor.h"

namespace awmr::pil {
namespace {

template <CombinedSplit split>
struct HostParts : AllParts<split> {
  typedef AnyLineFollower<float> Line;
};

/// Executes the control step on this machine. Here, all optional parts are compiled in, and the
/// parts that the mission does not need are disabled. The firmware does not contain such parts, but
/// its results must be equal.
template <class G, CombinedSplit split>
class HostExecutor : public Executor {
 public:
  HostExecutor(const AutopilotParameters& parameters, const Mission& mission)
      : parameters_(&parameters), mission_(&mission) {}

  Result<std::uint8_t> start() override {
    const AutopilotParameters& p = *parameters_;
    const bool good = start_autopilot(
        autopilot_, &p.block, p.surge.lines.data(), p.surge.lines.size(), p.yaw.lines.data(),
        p.yaw.lines.size(), p.crc, p.rest ? &*p.rest : nullptr, p.observer ? &*p.observer : nullptr,
        p.mode_gains ? &*p.mode_gains : nullptr);
    set_up();
    return std::uint8_t{good ? kFaultNone : kFaultParameters};
  }

  Status reset() override {
    AWMR_RETURN_IF_ERROR(start());
    if (!points_.points_m.empty()) AWMR_RETURN_IF_ERROR(follow(points_));
    is_reset_ = true;
    return {};
  }

  Status follow(const Points& points) override {
    points_ = points;
    const int count = static_cast<int>(points_.points_m.size());
    if (const auto& line = mission_->line) {
      follow_line(autopilot_, {points_.points_m.data(), count, line->corner_m, line->law},
                  parameters_->sample_time_s);
    } else {
      follow_waypoints(autopilot_, Waypoints<float>{points_.points_m.data(), count,
                                                    points_.acceptance_m, mission_->skip_passed});
    }
    return {};
  }

  Result<Step> step(const AutopilotInput& input) override {
    Step step;
    step.restarted = std::exchange(is_reset_, false);
    autopilot_step(autopilot_, input, step.output);
    return step;
  }

 private:
  /// Sets up the parts of the mission, as pil_set_up() in the firmware's mission.h does.
  void set_up() {
    const Mission& mission = *mission_;
    const float sample_time_s = parameters_->sample_time_s;
    filter_position(autopilot_, parameters_->position);
    if (mission.path) follow_path(autopilot_, mission.path->path, mission.path->gain_per_s);
    if (mission.slow_down_m) part_of<SlowDown<float>>(autopilot_).distance_m = *mission.slow_down_m;
    if (mission.avoidance) {
      sectors_.resize(mission.obstacles.size());
      avoid_obstacles(autopilot_, *mission.avoidance, mission.obstacles.data(), sectors_.data(),
                      static_cast<int>(mission.obstacles.size()));
    }
    if (mission.shaping) shape_headings(autopilot_, *mission.shaping, sample_time_s);
    if (mission.observers) observe_disturbance(autopilot_, *mission.observers, sample_time_s);
  }

  const AutopilotParameters* parameters_;
  const Mission* mission_;
  Autopilot<G, HostParts<split>> autopilot_{};
  Points points_;
  bool is_reset_ = false;
  std::vector<Sector<float>> sectors_;
};

template <class G>
std::unique_ptr<Executor> host_executor_of(const AutopilotParameters& parameters,
                                           const Mission& mission) {
  if (parameters.split == CombinedSplit::kFixedHalf) {
    return std::make_unique<HostExecutor<G, CombinedSplit::kFixedHalf>>(parameters, mission);
  }
  return std::make_unique<HostExecutor<G, CombinedSplit::kRedistribute>>(parameters, mission);
}

}  // namespace

std::unique_ptr<Executor> host_executor(const AutopilotParameters& parameters,
                                        const Mission& mission) {
  if (parameters.resistance == ResistanceForm::kTable && parameters.rest) {
    return host_executor_of<RestingTable>(parameters, mission);
  }
  if (parameters.resistance == ResistanceForm::kTable) {
    return host_executor_of<ResistanceTable>(parameters, mission);
  }
  return host_executor_of<Resistance<float>>(parameters, mission);
}

}  // namespace awmr::pil
