/// Scalar type with explicit conversion from double and no conversion to other types. A template
/// that compiles with it does not compute in double by accident when its scalar is float.
#pragma once

#include <cmath>

namespace awmr::testing {

class Strict {
 public:
  Strict() = default;
  explicit Strict(double value) : value_(value) {}
  double value() const { return value_; }

  friend Strict operator+(Strict a, Strict b) { return Strict(a.value_ + b.value_); }
  friend Strict operator-(Strict a, Strict b) { return Strict(a.value_ - b.value_); }
  friend Strict operator*(Strict a, Strict b) { return Strict(a.value_ * b.value_); }
  friend Strict operator/(Strict a, Strict b) { return Strict(a.value_ / b.value_); }
  friend Strict operator-(Strict a) { return Strict(-a.value_); }
  Strict& operator+=(Strict b) { return *this = *this + b; }
  Strict& operator-=(Strict b) { return *this = *this - b; }
  friend bool operator<(Strict a, Strict b) { return a.value_ < b.value_; }
  friend bool operator>(Strict a, Strict b) { return a.value_ > b.value_; }
  friend bool operator<=(Strict a, Strict b) { return a.value_ <= b.value_; }
  friend bool operator>=(Strict a, Strict b) { return a.value_ >= b.value_; }

  friend Strict abs(Strict a) { return Strict(std::abs(a.value_)); }
  friend Strict sin(Strict a) { return Strict(std::sin(a.value_)); }
  friend Strict cos(Strict a) { return Strict(std::cos(a.value_)); }
  friend Strict atan(Strict a) { return Strict(std::atan(a.value_)); }
  friend Strict atan2(Strict y, Strict x) { return Strict(std::atan2(y.value_, x.value_)); }
  friend Strict sqrt(Strict a) { return Strict(std::sqrt(a.value_)); }
  friend Strict pow(Strict a, Strict b) { return Strict(std::pow(a.value_, b.value_)); }

 private:
  double value_ = 0.0;
};

}  // namespace awmr::testing
