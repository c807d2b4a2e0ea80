// Measures the peak arithmetic rate of one core: independent fused multiply-adds of doubles in
// registers, without loads or stores. Reference for scripts/bench.
// usage: fma_peak [--benchmark_format=json ...], as for every Google Benchmark program
#include <benchmark/benchmark.h>

namespace {

/// Number of independent sums. An FMA takes four cycles and two can start per cycle, so eight must
/// be in flight. Twelve sums and their two constants fit into the sixteen registers of every
/// processor with FMA.
constexpr int kSums = 12;
/// Number of rounds of FMAs between two readings of the clock.
constexpr int kRounds = 10000;

using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

/// Repeats s = s x + y for twelve sums s; x and y keep the sums near 1. The compiler cannot remove
/// the work, because empty assembler statements hide x and y from it and seem to read the sums.
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

/// Counts two floating-point operations per FMA and lane.
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
