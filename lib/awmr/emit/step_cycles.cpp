#include <algorithm>
#include <cstdint>
#include <set>

#include "awmr/emit/emit.h"

namespace awmr {
namespace {

/// Cycles of a step that passes 16 waypoints at once.
constexpr std::uint32_t kWaypointCycles = 32'000;

/// Cycles of a step in which this part guides the vehicle; 0 if it does not guide.
std::uint32_t guidance_cycles(FirmwarePart part) {
  switch (part) {
    case FirmwarePart::kLine:
      return 70'000;  // passing all segments of a polyline in one step
    case FirmwarePart::kPath:
      return 38'000;
    case FirmwarePart::kAvoidance:
      return 112'000;  // several obstacles near the path
    default:
      return 0;
  }
}

/// Cycles that a part needs in addition to the guidance.
std::uint32_t added_cycles(FirmwarePart part) {
  switch (part) {
    case FirmwarePart::kObserver:
      return 14'000;
    case FirmwarePart::kShaping:
      return 6'000;
    case FirmwarePart::kSlowDown:
      return 3'000;
    default:
      return 0;
  }
}

}  // namespace

std::set<FirmwarePart> parts_with(std::set<FirmwarePart> parts, const ModeGains& gains) {
  if (gains.has_observer()) parts.insert(FirmwarePart::kObserver);
  return parts;
}

std::uint32_t longest_step_cycles(const std::set<FirmwarePart>& parts, ResistanceForm resistance) {
  std::uint32_t guidance = kWaypointCycles;
  std::uint32_t added = resistance == ResistanceForm::kPowf ? 16'000 : 0;
  for (const FirmwarePart part : parts) {
    guidance = std::max(guidance, guidance_cycles(part));
    added += added_cycles(part);
  }
  return guidance + added;
}

}  // namespace awmr
