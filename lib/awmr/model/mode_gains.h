/// Gains of the modes of yaw control, and the names of the modes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "awmr/core/name_table.h"
#include "awmr/model/gains.h"
#include "awmr/model/yaw_mode.h"

namespace awmr {

inline constexpr NameTable<YawMode, 3> kYawModeNames{{{"differential", YawMode::kDifferential},
                                                      {"steering", YawMode::kSteering},
                                                      {"combined", YawMode::kCombined}}};
constexpr std::string_view name_of(YawMode mode) { return name_in(kYawModeNames, mode); }
inline constexpr YawMode kYawModes[] = {YawMode::kDifferential, YawMode::kSteering,
                                        YawMode::kCombined};

/// Gains for every mode: one set, and the sets of modes that have gains of their own.
class ModeGains {
 public:
  ModeGains() = default;
  /// One set for all modes. Not explicit, so that a function that takes ModeGains also accepts one
  /// set.
  ModeGains(const Gains<double>& gains) : common_(gains) {}  // NOLINT(google-explicit-constructor)

  /// The gains to use in a mode.
  const Gains<double>& in(YawMode mode) const {
    const auto& own = own_[static_cast<std::size_t>(mode)];
    return own ? *own : common_;
  }
  /// The gains of the modes that have none of their own. In gains.json: /heading and /speed.
  const Gains<double>& common() const { return common_; }
  /// True if the mode has gains of its own. In gains.json: /modes/MODE.
  bool has_own(YawMode mode) const { return own_[static_cast<std::size_t>(mode)].has_value(); }
  /// True if at least one mode has an observer.
  bool has_observer() const {
    return in(YawMode::kDifferential).observer.is_on() || in(YawMode::kSteering).observer.is_on() ||
           in(YawMode::kCombined).observer.is_on();
  }
  /// The modes that a file lists one by one: all modes if a mode has gains of its own, else none.
  std::span<const YawMode> listed_modes() const {
    const bool has_any_own = has_own(YawMode::kDifferential) || has_own(YawMode::kSteering) ||
                             has_own(YawMode::kCombined);
    return has_any_own ? std::span<const YawMode>(kYawModes) : std::span<const YawMode>();
  }
  void set(YawMode mode, const Gains<double>& gains) {
    own_[static_cast<std::size_t>(mode)] = gains;
  }

 private:
  Gains<double> common_{};
  std::array<std::optional<Gains<double>>, kYawModeCount> own_ = {};
};

}  // namespace awmr
