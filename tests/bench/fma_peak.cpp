// What one core's arithmetic units can do at the most: independent fused multiplications and
// additions of doubles in registers, with nothing to load or store. Held against by scripts/bench.
// usage: fma_peak [--benchmark_format=json ...], as of every program of Google Benchmark
#include <benchmark/benchmark.h>

namespace {

/// Sums that are computed side by side. An FMA takes four cycles, and two can begin in each: eight
/// have to be under way at any time. With their two constants twelve fit into the sixteen registers
/// that every processor with FMA has.
constexpr int kSums = 12;
/// Rounds between two looks at the clock.
constexpr int kRounds = 10000;

using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

/// s = s x + y in twelve sums, again and again; x and y keep them near 1. The compiler is not told x
/// and y, and is made to believe that the sums are read.
#define AWMR_FMA_ROUNDS(Vector)                                              \
  Vector x = Vector{} + 0.999;                                               \
  Vector y = Vector{} + 0.001;                                               \
  asm("" : "+v"(x), "+v"(y));                                                \
  Vector a = x, b = x, c = x, d = x, e = x, f = x;                           \
  Vector g = x, h = x, i = x, j = x, k = x, l = x;                           \
  for (auto _ : state) {                                                     \
    for (int round = 0; round < kRounds; ++round) {                          \
      a = a * x + y, b = b * x + y, c = c * x + y, d = d * x + y;            \
      e = e * x + y, f = f * x + y, g = g * x + y, h = h * x + y;            \
      i = i * x + y, j = j * x + y, k = k * x + y, l = l * x + y;            \
    }                                                                        \
    asm volatile("" : "+v"(a), "+v"(b), "+v"(c), "+v"(d), "+v"(e), "+v"(f)); \
    asm volatile("" : "+v"(g), "+v"(h), "+v"(i), "+v"(j), "+v"(k), "+v"(l)); \
  }

/// Two floating-point operations for each FMA of each lane.
void count(benchmark::State& state, int lanes) {
  const double operations = 2.0 * lanes * kSums * kRounds;
  state.counters["flop_per_s"] = benchmark::Counter(
      operations * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

__attribute__((target("avx2,fma"))) void avx2(benchmark::State& state) {
  AWMR_FMA_ROUNDS(Four)
  count(state, 4);
}

__attribute__((target("avx512f"))) void avx512(benchmark::State& state) {
  AWMR_FMA_ROUNDS(Eight)
  count(state, 8);
}

}  // namespace

int main(int count_of_words, char** words) {
  if (__builtin_cpu_supports("fma")) benchmark::RegisterBenchmark("avx2", avx2);
  if (__builtin_cpu_supports("avx512f")) benchmark::RegisterBenchmark("avx512", avx512);
  benchmark::Initialize(&count_of_words, words);
  benchmark::RunSpecifiedBenchmarks();
}
