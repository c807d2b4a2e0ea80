/// Parts: features of a firmware that can be compiled in or left out.
#pragma once

namespace awmr {

/// Empty struct that replaces a part that is not compiled in. Its members do nothing, and every
/// function on a part has an overload for this struct that does nothing. So a missing part needs no
/// flash, RAM or time. A part has those of these members that its callers use.
template <class Part>
struct Disabled {
  static constexpr bool kIsIn = false;  ///< the part is compiled in
  /// Sets the parameters of the part, which are in flash on an AVR.
  template <class Parameters>
  void start(const Parameters*) {}
  /// Switches the part off.
  void disable() {}
  /// Resets the state of the part after a step with the safe command, because the state no longer
  /// matches the motion of the vehicle.
  void reset() {}
  /// True if this part of the guidance will use the position in the next step.
  static constexpr bool needs_position() { return false; }
};

/// `Part` if kIsIn is true, else Disabled<Part>.
template <bool kIsIn, class Part>
struct Optional {
  typedef Part type;
};
template <class Part>
struct Optional<false, Part> {
  typedef Disabled<Part> type;
};

/// Returns the part of an object that inherits from its parts: the base class `Part`, which is
/// Disabled<...> if the part is not compiled in.
template <class Part, class Whole>
Part& part_of(Whole& whole) {
  return static_cast<Part&>(whole);
}

}  // namespace awmr
