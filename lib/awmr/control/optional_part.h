/// Parts: features of a firmware that are compiled in or left out. Freestanding C++14.
#pragma once

namespace awmr {

/// Empty stand-in for a part that is not compiled in. Each operation on a part has a no-op overload
/// for the stand-in, which therefore needs no flash, RAM or time.
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

/// Returns the base class `Part` of an object that inherits from its parts, or the base class
/// Disabled<...> if `Part` is that stand-in.
template <class Part, class Whole>
Part& part_of(Whole& whole) {
  return static_cast<Part&>(whole);
}

/// Disables a part; a no-op for a part that is not compiled in.
template <class Part>
void disable(Disabled<Part>&) {}

/// Resets a part. Called after a step with the safe command, because the state of the part then no
/// longer matches the vehicle's motion.
template <class Part>
void reset(Disabled<Part>&) {}

}  // namespace awmr
