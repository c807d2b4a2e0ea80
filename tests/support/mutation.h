#pragma once
// Constructs that scripts/mutants writes into the sources, so that all mutants of a folder are
// compiled at once. The environment variable AWMR_MUTANT selects one by its number when a test
// starts (not set: the unchanged program).
//
//   a + b   a + awmr_mutation::Sign{7} * b          mutant 7 changes the sign of the term
//   a * b   a * awmr_mutation::Factor{7} * b        mutant 7 divides
//   a < b   a < awmr_mutation::Order{7} < b         mutant 7 is <=
//   a && b  a && awmr_mutation::kept(7) && b        mutant 7 is false
//   0.5     awmr_mutation::number(7, 0.5, 1.0)      mutant 7 is 1.0
//   if (c)  if (awmr_mutation::chosen(7) != bool(c)) mutant 7 is !c
//
// Expressions that the compiler evaluates itself are not changed.

#include <cstdlib>
#include <type_traits>

namespace awmr_mutation {

inline int chosen_number() {
  static const int number = [] {
    const char* text = std::getenv("AWMR_MUTANT");
    return text == nullptr ? -1 : std::atoi(text);
  }();
  return number;
}

constexpr bool chosen(int id) {
  return !__builtin_is_constant_evaluated() && id == chosen_number();
}
constexpr bool kept(int id) { return !chosen(id); }

template <typename T>
constexpr T number(int id, T as_is, T changed) {
  return chosen(id) ? changed : as_is;
}

struct Sign {
  int id;
};
template <typename T>
constexpr auto operator*(Sign sign, const T& value) {
  using Value = std::decay_t<decltype(-value)>;
  return chosen(sign.id) ? Value(-value) : Value(value);
}

// Implements a mutated operator. `a op Kind{7}` gives a Half that keeps a; `Half op b` applies the
// original or the mutated operator to a and b.
template <typename Kind, typename A>
struct Half {
  const A& a;
  int id;
};

struct Factor {
  int id;
};
template <typename A>
constexpr Half<Factor, A> operator*(const A& a, Factor op) {
  return {a, op.id};
}
template <typename A, typename B>
constexpr auto operator*(Half<Factor, A> half, const B& b) {
  using Value = std::decay_t<decltype(half.a * b)>;
  return chosen(half.id) ? Value(half.a / b) : Value(half.a * b);
}

struct Share {
  int id;
};
template <typename A>
constexpr Half<Share, A> operator/(const A& a, Share op) {
  return {a, op.id};
}
template <typename A, typename B>
constexpr auto operator/(Half<Share, A> half, const B& b) {
  using Value = std::decay_t<decltype(half.a / b)>;
  return chosen(half.id) ? Value(half.a * b) : Value(half.a / b);
}

struct Order {
  int id;
};
#define AWMR_MUTATION_ORDER(as_is, changed)                         \
  template <typename A>                                             \
  constexpr Half<Order, A> operator as_is(const A& a, Order op) {   \
    return {a, op.id};                                              \
  }                                                                 \
  template <typename A, typename B>                                 \
  constexpr auto operator as_is(Half<Order, A> half, const B& b) {  \
    return chosen(half.id) ? (half.a changed b) : (half.a as_is b); \
  }
AWMR_MUTATION_ORDER(<, <=)
AWMR_MUTATION_ORDER(<=, <)
AWMR_MUTATION_ORDER(>, >=)
AWMR_MUTATION_ORDER(>=, >)
AWMR_MUTATION_ORDER(==, !=)
AWMR_MUTATION_ORDER(!=, ==)
#undef AWMR_MUTATION_ORDER

}  // namespace awmr_mutation
