/// The two inner loops of a log fit: a Runge-Kutta step of the derivatives of the state with
/// respect to the columns of the fit, and the product J^T J of the Jacobian. Private to identify/.
///
/// Both are compiled for several instruction sets, and the program selects the best one that the
/// processor supports. All give the same bits: none uses fused multiply-add, and sums have a fixed
/// order.
#pragma once

#include <array>
#include <cstddef>

#include "awmr/identify/logs/simulation/linear_rates.h"

namespace awmr {

inline constexpr std::size_t kStateSize = 7;
/// Number of rates of the state that depend on parameters: those of u, v, r and the steering angle.
inline constexpr std::size_t kDrivenSize = 4;
inline constexpr std::size_t kStages = 4;

/// Makes one classical Runge-Kutta step of h_s seconds of S, the derivatives of the state with
/// respect to the columns of the fit (linear_stepper.h):
///
///     S_dot = A S + B
///
/// `stages`: A at each Runge-Kutta stage of the state. `driven`: the rows of B that are not 0, at
/// each stage, [kStages][kDrivenSize][columns]. `s`: S, [kStateSize][columns], before and after the
/// step.
void step_sensitivities(const std::array<StateSlopes, kStages>& stages, const double* driven,
                        double h_s, std::size_t columns, double* s);

/// The number of columns of a row in memory is a multiple of this, for vector instructions.
inline constexpr std::size_t kRowVector = 4;

/// Adds rows^T rows to `sums`, on and above the diagonal. `rows`: [count][columns]. `sums`:
/// [columns][columns]. `columns`: a multiple of kRowVector.
void add_products(const double* rows, std::size_t count, std::size_t columns, double* sums);

}  // namespace awmr
