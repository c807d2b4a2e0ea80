/// Simulation of a sensor's low-pass filter of first or second order, and the derivatives of its
/// output with respect to the columns of the fit. Private to identify/.
#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/logs/simulation/command_path.h"

namespace awmr {

struct SensorFilter {
  TermColumn lag;                          ///< time constant T, s
  bool is_at_rows;                         ///< true: one step per row; false: continuous
  std::optional<TermColumn> damping = {};  ///< zeta > 0 of a filter of second order
};

/// One stage of a sensor's filter: its time constant, and the derivatives of this time constant.
template <class Scalar>
struct StageLag {
  Scalar lag_s;       ///< time constant of the stage, s
  Scalar by_lag;      ///< derivative with respect to the time constant T of the whole filter
  Scalar by_damping;  ///< derivative with respect to zeta, s
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
  /// `first`: initial output. `by_column`: derivatives of `first` with respect to the columns of
  /// the fit.
  FilterStage(const SensorFilter& filter, const StageLag<Scalar>& lag, Scalar first,
              std::vector<Scalar> by_column)
      : filter_(filter), lag_(lag), y_(first), by_column_(std::move(by_column)) {}

  /// Advances the filter by h_s seconds to the input u. `by`: derivatives of u, one per column.
  void next(Scalar u, const Scalar* by, double h_s, std::size_t columns);
  Scalar value() const { return y_; }
  const std::vector<Scalar>& by_column() const { return by_column_; }

 private:
  void move(Scalar u, const Scalar* by, double h_s, std::size_t columns);

  SensorFilter filter_;
  StageLag<Scalar> lag_;
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
/// A filter of second order is computed as two stages in series, with the time constants
///
///     T_1, T_2 = T (zeta +- i sqrt(1 - zeta^2))        (real if zeta > 1)
///
/// With one step per row, the filter of second order is a tracking filter (alpha-beta filter) of
/// positions, angles or counts, whose estimate of their rate is the reading. Its input is the mean
/// of u from row to row. With e_1 = exp(-h/T_1) and e_2 = exp(-h/T_2), the gains of the filter are
///
///     alpha = 1 - e_1 e_2,   beta = (1 - e_1)(1 - e_2)
///
/// The output y starts at the first reading of the window. The noise of this reading has an effect
/// that decays with the time constant T. The output of the first stage is not measured: it starts
/// as if the input had risen at a constant rate before.
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
  double input_ = 0.0;                  ///< last input of the pair
  std::vector<Complex> by_input_ = {};  ///< its derivatives
};

}  // namespace awmr
