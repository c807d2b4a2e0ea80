/// Finds changes of the limits and bounds in tune.json that make the constraints feasible. Private
/// to tune/ and apps/.
#pragma once

#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Note in messages that propose changes of limits. `tune` does not search the smallest change that
/// suffices, because each change that it tries takes up to some seconds.
inline constexpr const char* kSmallerMaySuffice = "smaller changes may also suffice";

/// Advice for a constraint that no gains meet: the limit to relax or, if tune.json has no such
/// limit, another change.
std::string advice_on(const std::string& constraint);

/// Pointer in tune.json to the limit of a constraint; "/bounds" if it has none.
std::string pointer_to(const std::string& constraint);

/// A limit of tune.json, set to a less strict value.
struct RelaxedLimit {
  const char* key;  ///< "limits/damping"
  double number;    ///< the new value of the limit
  /// True if the limit is limits/steering_rate_rms_degps.
  bool is_steering_rate;
  ConstraintContext context;  ///< the context in which the limit has this value
};

/// Returns, for each limit of the context that can be relaxed, some less strict values, strictest
/// first:
///   - a limit that is stricter than its default: values up to the default
///   - a damping ratio: also down to half of its value or half of its default, whichever is smaller
///   - noise_share: also up to twice its value or twice its default, whichever is larger
///   - the limit of the steering rate: up to 20 times its value (at most twice the maximum rate of
///     the servo), and larger values up to 0.9 of that rate
std::vector<std::vector<RelaxedLimit>> relaxed_limits(const ConstraintContext& context);

/// Returns changes of tune.json, as text such as "`limits/late_damping` 0.55". Each change alone
/// permits gains that meet the constraints that need no simulation. A change is a new value of one
/// limit, of one requested bound or of `form`. It is confirmed by the search with which tune()
/// finds its first gains, but from fewer initial guesses. `nearest`: the gains with the smallest
/// violation, used as a further initial guess.
std::vector<std::string> single_changes(const Gains<double>& nearest,
                                        const ConstraintContext& context,
                                        const TuneOptions& requested);

}  // namespace awmr
