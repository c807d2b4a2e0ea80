/// Scalar type that counts operations: instantiating the templates of model/, control/ and
/// simulate/ with it gives their number of operations.
#pragma once

#include <cmath>

namespace awmr::bench {

/// Numbers of operations so far in this program. Comparisons, changes of sign and selections are
/// not counted.
struct Operations {
  double additions = 0.0;  ///< and subtractions
  double multiplications = 0.0;
  double divisions = 0.0;
  double roots = 0.0;
  double powers = 0.0;
  double sines = 0.0;
  double cosines = 0.0;
  double arc_tangents = 0.0;
};
inline Operations operations;

class Counted {
 public:
  Counted() = default;
  Counted(double value) : value_(value) {}
  double value() const { return value_; }

  friend Counted operator+(Counted a, Counted b) {
    return tally(operations.additions, a.value_ + b.value_);
  }
  friend Counted operator-(Counted a, Counted b) {
    return tally(operations.additions, a.value_ - b.value_);
  }
  friend Counted operator*(Counted a, Counted b) {
    return tally(operations.multiplications, a.value_ * b.value_);
  }
  friend Counted operator/(Counted a, Counted b) {
    return tally(operations.divisions, a.value_ / b.value_);
  }
  friend Counted operator-(Counted a) { return -a.value_; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  friend bool operator<(Counted a, Counted b) { return a.value_ < b.value_; }
  friend bool operator>(Counted a, Counted b) { return a.value_ > b.value_; }
  friend bool operator<=(Counted a, Counted b) { return a.value_ <= b.value_; }
  friend bool operator>=(Counted a, Counted b) { return a.value_ >= b.value_; }

  friend Counted value_of(Counted a) { return a; }
  friend Counted abs(Counted a) { return std::abs(a.value_); }
  friend Counted sqrt(Counted a) { return tally(operations.roots, std::sqrt(a.value_)); }
  friend Counted hypot(Counted a, Counted b) { return sqrt(a * a + b * b); }
  friend Counted sin(Counted a) { return tally(operations.sines, std::sin(a.value_)); }
  friend Counted cos(Counted a) { return tally(operations.cosines, std::cos(a.value_)); }
  friend Counted atan(Counted a) { return tally(operations.arc_tangents, std::atan(a.value_)); }
  friend Counted atan2(Counted y, Counted x) {
    return tally(operations.arc_tangents, std::atan2(y.value_, x.value_));
  }
  friend Counted pow(Counted a, Counted b) {
    return tally(operations.powers, std::pow(a.value_, b.value_));
  }

 private:
  static Counted tally(double& count, double result) {
    ++count;
    return result;
  }

  double value_ = 0.0;
};

}  // namespace awmr::bench
