#include "injection_result.h"

#include <algorithm>
#include <cmath>

#include "injections.h"

namespace awmr::pil {
namespace {

using cli::Injection;

bool is_safe(const Allocation<float>& command) {
  return std::max({std::abs(command.force.left), std::abs(command.force.right),
                   std::abs(command.steering_rad)}) <= 0.0F;
}

/// Evaluates a failure that must disarm the vehicle. The first fault of the autopilot must come in
/// time and with the right cause. From then to the end, the command must be safe.
Injected disarming_of(const LoopSetup& setup, const std::vector<LoopRow>& rows) {
  Injected result;
  result.expected = effect_of(setup.injection).fault;
  const auto has_fault = [](const LoopRow& row) { return row.step.output.fault != kFaultNone; };
  const auto first = std::find_if(rows.begin(), rows.end(), has_fault);
  if (first == rows.end()) return result;
  const auto at = static_cast<std::size_t>(first - rows.begin());
  result.seen = first->step.output.fault;
  result.quiet = at >= setup.middle;
  result.worked = (result.seen & result.expected) != 0 &&
                  is_expected_cause(setup.injection, first->cause) &&
                  static_cast<double>(at - std::min(at, setup.middle)) * setup.sample_time_s <=
                      effect_of(setup.injection).within_s;
  result.safe = std::all_of(first, rows.end(), [&](const LoopRow& row) {
    return has_fault(row) && is_safe(row.step.output.command);
  });
  return result;
}

}  // namespace

std::vector<std::size_t> restarts_of(const std::vector<LoopRow>& rows) {
  std::vector<std::size_t> restarts;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k].step.restarted) restarts.push_back(k);
  }
  return restarts;
}

Injected injected_of(const LoopSetup& setup, const std::vector<LoopRow>& rows) {
  Injected result;
  result.expected = effect_of(setup.injection).fault;
  if (disarms(setup.injection)) return disarming_of(setup, rows);
  const Window window = injection_window(setup.injection, setup.middle, rows.size());
  result.seen = window.first < window.last ? 0xFF : 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const AutopilotOutput& out = rows[i].step.output;
    if (i < window.first || i >= window.last) {
      result.quiet = result.quiet && out.fault == kFaultNone;
      continue;
    }
    result.seen &= out.fault;
    result.safe = result.safe && is_safe(out.command);
  }
  result.worked = setup.injection == Injection::kReset ? restarts_of(rows) == setup.resets
                                                       : (result.seen & result.expected) != 0;
  return result;
}

}  // namespace awmr::pil
