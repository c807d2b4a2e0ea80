#include "executor.h"

namespace awmr::pil {
namespace {

template <class G>
class HostExecutor : public Executor {
 public:
  explicit HostExecutor(const AutopilotParameters& parameters) : parameters_(&parameters) {}

  Result<std::uint8_t> start() override {
    const AutopilotParameters& p = *parameters_;
    const bool good =
        start_autopilot(autopilot_, &p.block, p.surge.lines.data(), p.surge.lines.size(),
                        p.yaw.lines.data(), p.yaw.lines.size(), p.crc);
    return std::uint8_t{good ? kFaultNone : kFaultParameters};
  }

  Status follow(const Points& points) override {
    points_ = points;
    follow_waypoints(autopilot_, Waypoints<float>{points_.points_m.data(),
                                                  static_cast<int>(points_.points_m.size()),
                                                  points_.acceptance_m, false});
    return {};
  }

  Result<Step> step(const AutopilotInput& input) override {
    Step step;
    autopilot_step(autopilot_, input, step.output);
    return step;
  }

 private:
  const AutopilotParameters* parameters_;
  Autopilot<G> autopilot_{};
  Points points_;
};

}  // namespace

std::unique_ptr<Executor> host_executor(const AutopilotParameters& parameters) {
  if (parameters.resistance == ResistanceForm::kTable) {
    return std::make_unique<HostExecutor<ResistanceTable>>(parameters);
  }
  return std::make_unique<HostExecutor<Resistance<float>>>(parameters);
}

}  // namespace awmr::pil
