/// List of the guidance laws that follow a line.
///
/// To add a law, write its header (Polyline in line.h lists the members that a law needs), include
/// the header here and add the law to LineLaws. Scenario files, the simulator, `awmr emit
/// --line-law` and `awmr pil` then support it.
#pragma once

#include "awmr/control/guidance/ilos.h"
#include "awmr/control/guidance/line_of_sight.h"
#include "awmr/control/guidance/pure_pursuit.h"
#include "awmr/control/guidance/stanley.h"

namespace awmr {

/// The class template `List` with all guidance laws as its arguments. For example, with
/// std::variant the result is a variant of all laws. The first law is the default.
template <template <class...> class List, class T>
using LineLaws = List<LineOfSight<T>, PurePursuit<T>, IntegralLos<T>, Stanley<T>>;

namespace detail {
/// @cond  Doxygen reports the recursive base class as an error.
template <int kPlace, class First, class... Rest>
struct LawAt : LawAt<kPlace - 1, Rest...> {};
template <class First, class... Rest>
struct LawAt<0, First, Rest...> {
  typedef First Law;
};
/// @endcond
}  // namespace detail

/// Selects a guidance law by its place k in LineLaws, counted from 0. The law is the member type
/// Law of LineLaws<LineLawAt<k>::Of, T>.
template <int kPlace>
struct LineLawAt {
  template <class... Laws>
  using Of = detail::LawAt<kPlace, Laws...>;
};

}  // namespace awmr
