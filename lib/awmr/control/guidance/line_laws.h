/// The laws for lines. Freestanding C++14.
///
/// To add one: write its header (what a law has is stated at Polyline in line.h), include it here,
/// and list it below. Scenario files, the simulator, `awmr emit --line-law` and `awmr pil` then
/// have it.
#pragma once

#include "awmr/control/guidance/ilos.h"
#include "awmr/control/guidance/line_of_sight.h"
#include "awmr/control/guidance/pure_pursuit.h"
#include "awmr/control/guidance/stanley.h"

namespace awmr {

/// List<LineOfSight<T>, ...>: every law; the first is the default.
template <template <class...> class List, class T>
using LineLaws = List<LineOfSight<T>, PurePursuit<T>, IntegralLos<T>, Stanley<T>>;

namespace detail {
template <int kPlace, class First, class... Rest>
struct LawAt : LawAt<kPlace - 1, Rest...> {};
template <class First, class... Rest>
struct LawAt<0, First, Rest...> {
  typedef First Law;
};
}  // namespace detail

/// LineLaws<LineLawAt<k>::Of, T>::Law: the law at place k, from 0.
template <int kPlace>
struct LineLawAt {
  template <class... Laws>
  using Of = detail::LawAt<kPlace, Laws...>;
};

}  // namespace awmr
