#include "awmr/identify/logs/simulation/sensitivity_kernel.h"

namespace awmr {
namespace {

// The functions below must be inlined into their callers, which are compiled for several
// instruction sets. The inlined code then uses the set of its caller.
#if defined(__GNUC__)
#define AWMR_INLINE inline __attribute__((always_inline))
#else
#define AWMR_INLINE inline
#endif

// Tells the compiler that the columns are independent of each other, which it cannot prove.
#if defined(__GNUC__) && !defined(__clang__)
#define AWMR_INDEPENDENT_COLUMNS _Pragma("GCC ivdep")
#else
#define AWMR_INDEPENDENT_COLUMNS
#endif

/// Derivatives of the seven components of the state with respect to one column of the fit, or the
/// rates of these derivatives.
struct Column {
  double x, y, psi, u, v, r, steering;
};

AWMR_INLINE Column rate_of(const StateSlopes& a, const double* b, std::size_t columns,
                           const Column& s) {
  return {.x = a.x_psi * s.psi + a.x_u * s.u + a.x_v * s.v,
          .y = a.y_psi * s.psi + a.y_u * s.u + a.y_v * s.v,
          .psi = s.r,
          .u = a.u_psi * s.psi + a.u_u * s.u + a.u_v * s.v + a.u_r * s.r +
               a.u_steering * s.steering + b[0],
          .v = a.v_psi * s.psi + a.v_u * s.u + a.v_v * s.v + a.v_r * s.r +
               a.v_steering * s.steering + b[columns],
          .r = a.r_u * s.u + a.r_v * s.v + a.r_r * s.r + a.r_steering * s.steering + b[2 * columns],
          .steering = a.steering_steering * s.steering + b[3 * columns]};
}

AWMR_INLINE Column moved_column(const Column& s, const Column& d, double h) {
  return {s.x + h * d.x, s.y + h * d.y, s.psi + h * d.psi,          s.u + h * d.u,
          s.v + h * d.v, s.r + h * d.r, s.steering + h * d.steering};
}

AWMR_INLINE void step_columns(const StateSlopes* __restrict a, const double* __restrict b, double h,
                              std::size_t columns, double* __restrict s) {
  const std::size_t stage = kDrivenSize * columns;
  AWMR_INDEPENDENT_COLUMNS
  for (std::size_t c = 0; c < columns; ++c) {
    double* const at = s + c;
    const Column s0{at[0],           at[columns],     at[2 * columns], at[3 * columns],
                    at[4 * columns], at[5 * columns], at[6 * columns]};
    const Column k1 = rate_of(a[0], b + c, columns, s0);
    const Column k2 = rate_of(a[1], b + stage + c, columns, moved_column(s0, k1, 0.5 * h));
    const Column k3 = rate_of(a[2], b + 2 * stage + c, columns, moved_column(s0, k2, 0.5 * h));
    const Column k4 = rate_of(a[3], b + 3 * stage + c, columns, moved_column(s0, k3, h));
    Column next = moved_column(s0, k1, h / 6.0);
    next = moved_column(next, k2, h / 3.0);
    next = moved_column(next, k3, h / 3.0);
    next = moved_column(next, k4, h / 6.0);
    at[0] = next.x;
    at[columns] = next.y;
    at[2 * columns] = next.psi;
    at[3 * columns] = next.u;
    at[4 * columns] = next.v;
    at[5 * columns] = next.r;
    at[6 * columns] = next.steering;
  }
}

/// Adds the products of all rows to the sums, one tile of kTile x kTile sums after the other,
/// because the sums of a tile then stay in registers.
AWMR_INLINE void add_rows(const double* __restrict rows, std::size_t count, std::size_t columns,
                          double* __restrict sums) {
  constexpr std::size_t kTile = kRowVector;
  for (std::size_t i = 0; i < columns; i += kTile) {
    for (std::size_t j = i; j < columns; j += kTile) {
      double tile[kTile][kTile] = {};
      for (std::size_t k = 0; k < count; ++k) {
        const double* const left = rows + k * columns + i;
        const double* const right = rows + k * columns + j;
        for (std::size_t a = 0; a < kTile; ++a) {
          for (std::size_t b = 0; b < kTile; ++b) tile[a][b] += left[a] * right[b];
        }
      }
      for (std::size_t a = 0; a < kTile; ++a) {
        for (std::size_t b = 0; b < kTile; ++b) sums[(i + a) * columns + j + b] += tile[a][b];
      }
    }
  }
}

/// The two inner loops, compiled for one instruction set.
struct Kernels {
  void (*step)(const StateSlopes*, const double*, double, std::size_t, double*);
  void (*add)(const double*, std::size_t, std::size_t, double*);
};

constexpr Kernels kBaseline{[](const StateSlopes* a, const double* b, double h, std::size_t n,
                               double* s) { step_columns(a, b, h, n, s); },
                            [](const double* rows, std::size_t count, std::size_t n, double* sums) {
                              add_rows(rows, count, n, sums);
                            }};

#if defined(__x86_64__) && defined(__GNUC__)

#define AWMR_KERNELS_FOR(NAME, SET)                                                              \
  __attribute__((target(SET))) void step_##NAME(const StateSlopes* a, const double* b, double h, \
                                                std::size_t n, double* s) {                      \
    step_columns(a, b, h, n, s);                                                                 \
  }                                                                                              \
  __attribute__((target(SET))) void add_##NAME(const double* rows, std::size_t count,            \
                                               std::size_t n, double* sums) {                    \
    add_rows(rows, count, n, sums);                                                              \
  }

AWMR_KERNELS_FOR(avx2, "avx2")
AWMR_KERNELS_FOR(avx512, "avx512f,prefer-vector-width=512")

#undef AWMR_KERNELS_FOR

Kernels best_kernels() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return {step_avx512, add_avx512};
  if (__builtin_cpu_supports("avx2")) return {step_avx2, add_avx2};
  return kBaseline;
}

#else

Kernels best_kernels() { return kBaseline; }

#endif

const Kernels& kernels() {
  static const Kernels chosen = best_kernels();
  return chosen;
}

}  // namespace

void step_sensitivities(const std::array<StateSlopes, kStages>& stages, const double* driven,
                        double h_s, std::size_t columns, double* s) {
  kernels().step(stages.data(), driven, h_s, columns, s);
}

void add_products(const double* rows, std::size_t count, std::size_t columns, double* sums) {
  kernels().add(rows, count, columns, sums);
}

}  // namespace awmr
