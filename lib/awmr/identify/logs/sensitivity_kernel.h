/// The two inner loops of a log fit, over independent columns. Private to identify/.
///
/// Compiled for several instruction sets; the best one of the processor is selected at run time.
/// None uses fused multiply-add, and every column is summed in the same order, so all give the same
/// bits.
#pragma once

#include <array>
#include <cstddef>

#include "awmr/identify/logs/linear_rates.h"

namespace awmr {

/// Components of State, in its order.
inline constexpr std::size_t kStateSize = 7;
/// Number of rates that depend on parameters: of u, v, r and the steering angle.
inline constexpr std::size_t kDrivenSize = 4;
/// Stages of the Runge-Kutta method.
inline constexpr std::size_t kStages = 4;

/// One classical Runge-Kutta step of h seconds of the sensitivities S, along with the state's:
///
///     S_dot = A S + B
///
/// `stages`: A at each stage. `driven`: B at each stage, [kStages][kDrivenSize][columns], of the
/// rates of u, v, r and the steering angle. `s`: [kStateSize][columns], in and out.
void step_sensitivities(const std::array<StateSlopes, kStages>& stages, const double* driven,
                        double h_s, std::size_t columns, double* s);

/// The number of columns of a row is a multiple of this.
inline constexpr std::size_t kRowVector = 4;

/// sums += rows^T rows, on and above the diagonal. `rows`: [count][columns]; `sums`:
/// [columns][columns]; columns is a multiple of kRowVector.
void add_products(const double* rows, std::size_t count, std::size_t columns, double* sums);

}  // namespace awmr
