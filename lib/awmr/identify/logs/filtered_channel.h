/// Simulation of a sensor's low-pass filter of first or second order, and the derivatives of its
/// output with respect to the columns of the fit. Private to identify/.
#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/logs/command_path.h"

namespace awmr {

struct SensorFilter {
  DelayColumn lag;       ///< time constant T, s
  bool is_at_rows;       ///< true: one filter step per row of the log; false: continuous
  double damping = 0.0;  ///< zeta, in (0, 1], if the filter is of second order; else 0
};

/// Output y of a filter of first order with the input u and the time constant T, and its
/// derivatives with respect to the columns (unknowns) of the fit, see linear_stepper.h. With the
/// time h between two rows and e = exp(-h/T),
///
///     y(t + h) = u(t + h) - q (u(t + h) - u(t)) + e (y(t) - u(t))
///     q = (T/h)(1 - e)   continuous filter: T dy/dt = u - y, u linear between rows
///     q = e              one step per row:  y(t + h) = e y(t) + (1 - e) u(t + h)
///
/// `Scalar`: double, or complex for one of the two stages of a filter of second order.
template <class Scalar>
class FilterStage {
 public:
  /// `direction`: time constant of this stage, divided by that of the whole filter (complex for
  /// second order). `first`: initial output. `by_column`: derivatives of `first` with respect to
  /// the columns of the fit.
  FilterStage(const SensorFilter& filter, Scalar direction, Scalar first,
              std::vector<Scalar> by_column)
      : lag_s_(direction * filter.lag.delay_s),
        direction_(direction),
        column_(filter.lag.column),
        is_at_rows_(filter.is_at_rows),
        y_(first),
        by_column_(std::move(by_column)) {}

  /// Advances the filter by h_s seconds to the input u. `by`: derivatives of u, one per column.
  void next(Scalar u, const Scalar* by, double h_s, std::size_t columns);
  Scalar value() const { return y_; }
  const std::vector<Scalar>& by_column() const { return by_column_; }

 private:
  void move(Scalar u, const Scalar* by, double h_s, std::size_t columns);

  Scalar lag_s_;
  Scalar direction_;
  std::size_t column_;
  bool is_at_rows_;
  Scalar y_;
  Scalar u_before_ = 0.0;
  bool has_before_ = false;
  std::vector<Scalar> by_column_;
  std::vector<Scalar> by_before_;
};

/// A sensor's filter of first order, or of second order:
///
///     T^2 d2y/dt2 + 2 zeta T dy/dt + y = u
///
/// A filter of second order is computed as two stages in series, with the complex time constants T
/// exp(i phi) and T exp(-i phi), cos phi = zeta. The output y starts at the first reading of the
/// window. The noise of this reading has an effect that decays with the time constant T. The output
/// of the first stage is not measured: it starts as if the input had risen at a constant rate
/// before.
class FilteredChannel {
 public:
  /// `first`: first reading of the window. `columns`: number of columns of the fit, with respect to
  /// which y is differentiated. If it is 0, only y is computed.
  FilteredChannel(const SensorFilter& filter, double first, std::size_t columns)
      : filter_(filter), y_(first), by_column_(columns, 0.0) {}

  /// Advances the filter by h_s seconds to the input u. `by`: derivatives of u, one per column.
  void next(double u, const double* by, double h_s, std::size_t columns);
  double value() const { return y_; }
  const std::vector<double>& by_column() const { return by_column_; }

 private:
  using Complex = std::complex<double>;
  void start_pair(double u, const std::vector<Complex>& by);
  void next_of_pair(double u, const double* by, double h_s, std::size_t columns);

  SensorFilter filter_;
  double y_;
  std::vector<double> by_column_;
  std::optional<FilterStage<double>> single_;
  std::vector<FilterStage<Complex>> pair_;
};

}  // namespace awmr
