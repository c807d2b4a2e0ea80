/// Optional features of a firmware. Freestanding C++14.
#pragma once

namespace awmr {

/// Empty stand-in for a part that is not compiled in. It needs no flash, RAM or time: each operation
/// on a part has a no-op overload for it.
template <class Part>
struct Disabled {};

/// `Part`, or Disabled<Part>.
template <bool kIsIn, class Part>
struct Optional {
  typedef Part type;
};
template <class Part>
struct Optional<false, Part> {
  typedef Disabled<Part> type;
};

/// A part of an object that inherits from its parts, or its Disabled stand-in.
template <class Part, class Whole>
Part& part_of(Whole& whole) {
  return static_cast<Part&>(whole);
}

/// Disables a part; a no-op for a part that is not compiled in.
template <class Part>
void disable(Disabled<Part>&) {}

/// Resets a part after a step with the safe command: its memory of the vehicle's motion is no longer
/// valid.
template <class Part>
void reset(Disabled<Part>&) {}

}  // namespace awmr
