/// Parts: features of a firmware that can be compiled in or left out.
#pragma once

namespace awmr {

/// Empty struct that replaces a part that is not compiled in. Every function on a part has an
/// overload for this struct that does nothing. So a missing part needs no flash, RAM or time.
template <class Part>
struct Disabled {};

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

/// Switches a part off. No-op for a part that is not compiled in.
template <class Part>
void disable(Disabled<Part>&) {}

/// Resets the state of a part after a step with the safe command, because the state no longer
/// matches the motion of the vehicle.
template <class Part>
void reset(Disabled<Part>&) {}

}  // namespace awmr
