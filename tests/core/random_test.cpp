#include "awmr/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace awmr::testing {
namespace {

using Counter = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

/// Philox4x32-10 as published by its authors, independent of the library that the program uses.
/// [Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011, section
/// 3.3]
Counter philox(Counter c, Key k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * c[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32U) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32U) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
    k[0] += 0x9E3779B9U;
    k[1] += 0xBB67AE85U;
  }
  return c;
}

// The vectors `philox4x32 10` of Random123's tests/kat_vectors.
TEST(Philox, TheReferenceGivesThePublishedAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
            (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0U, ~0U, ~0U, ~0U}, {~0U, ~0U}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, BitsAreThePhiloxBlocksOfSeedStreamAndCount) {
  for (const std::uint64_t seed : {0ULL, 1ULL, 0x299f31d0a4093822ULL}) {
    for (const std::uint64_t stream : {0ULL, 1ULL, 0x0370734413198a2eULL}) {
      Random random(seed, stream);
      for (std::uint32_t block = 0; block < 5; ++block) {
        const Counter expected =
            philox({block, 0, static_cast<std::uint32_t>(stream),
                    static_cast<std::uint32_t>(stream >> 32U)},
                   {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)});
        for (const std::uint32_t word : expected) EXPECT_EQ(random.bits(), word);
      }
    }
  }
}

TEST(Random, ACopyGoesOnAsTheOriginal) {
  Random one(7, 3);
  for (int i = 0; i < 5; ++i) (void)one.normal();
  Random other = one;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(one.normal(), other.normal());
}

// With fixed seeds the tests below are deterministic. Their bounds are 5 standard deviations of the
// statistic: a correct generator misses one with probability 6e-7.
constexpr int kDraws = 100000;
const double kRootDraws = std::sqrt(static_cast<double>(kDraws));

TEST(Random, UniformHasItsRangeAndMoments) {
  Random random(42, 0);
  double sum = 0.0;
  double square = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u - 0.5;
    square += (u - 0.5) * (u - 0.5);
  }
  // For a uniform number u, Var u = 1/12 and Var (u - 1/2)^2 = 1/80 - 1/144 = 1/180.
  EXPECT_NEAR(sum / kDraws, 0.0, 5.0 * std::sqrt(1.0 / 12.0) / kRootDraws);
  EXPECT_NEAR(square / kDraws, 1.0 / 12.0, 5.0 * std::sqrt(1.0 / 180.0) / kRootDraws);
}

TEST(Random, NormalHasItsMoments) {
  Random random(42, 1);
  std::array<double, 5> moment{};
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    ASSERT_TRUE(std::isfinite(z));
    for (int k = 1; k <= 4; ++k) moment[k] += std::pow(z, k) / kDraws;
  }
  // E z^k for k = 1..4 is 0, 1, 0, 3; Var z^k = E z^2k - (E z^k)^2 = 1, 2, 15, 105 - 9 = 96.
  EXPECT_NEAR(moment[1], 0.0, 5.0 * std::sqrt(1.0) / kRootDraws);
  EXPECT_NEAR(moment[2], 1.0, 5.0 * std::sqrt(2.0) / kRootDraws);
  EXPECT_NEAR(moment[3], 0.0, 5.0 * std::sqrt(15.0) / kRootDraws);
  EXPECT_NEAR(moment[4], 3.0, 5.0 * std::sqrt(96.0) / kRootDraws);
}

TEST(Random, NormalHasItsDistribution) {
  Random random(42, 2);
  std::vector<double> z(kDraws);
  for (double& value : z) value = random.normal();
  std::sort(z.begin(), z.end());
  double distance = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double expected = 0.5 * std::erfc(-z[i] / std::sqrt(2.0));
    distance = std::max(
        {distance, (i + 1.0) / kDraws - expected, expected - static_cast<double>(i) / kDraws});
  }
  // Kolmogorov: P(sqrt(n) D > x) is about 2 exp(-2 x^2), 6e-7 at x = 2.74.
  EXPECT_LT(kRootDraws * distance, 2.74);
}

TEST(Random, StreamsAndSeedsAreUncorrelated) {
  const auto correlation = [](Random a, Random b) {
    double sum = 0.0;
    for (int i = 0; i < kDraws; ++i) sum += a.normal() * b.normal();
    return sum / kDraws;
  };
  // The product of two independent standard normal numbers has mean 0 and variance 1.
  EXPECT_NEAR(correlation({1, 0}, {1, 1}), 0.0, 5.0 / kRootDraws);
  EXPECT_NEAR(correlation({1, 0}, {2, 0}), 0.0, 5.0 / kRootDraws);
  EXPECT_NEAR(correlation({1, 2}, {2, 1}), 0.0, 5.0 / kRootDraws);
}

TEST(Random, StreamsDoNotOverlap) {
  // 1000 streams of 8 words: if two shared a block of 4 words, its first two words would agree.
  std::vector<std::uint64_t> pairs;
  for (std::uint64_t stream = 0; stream < 1000; ++stream) {
    Random random(5, stream);
    for (int block = 0; block < 2; ++block) {
      const std::uint64_t high = random.bits();
      pairs.push_back(high << 32U | random.bits());
      (void)random.bits();
      (void)random.bits();
    }
  }
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace
}  // namespace awmr::testing
