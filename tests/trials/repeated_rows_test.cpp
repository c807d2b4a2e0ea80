/// Repeated rows are reported, unless coarse readings explain them by chance.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/core/random.h"
#include "trial_text.h"

namespace awmr::testing::repeated_rows_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Timing of a table of runs.
struct Timing {
  double scatter;  ///< relative standard deviation of a run's time
  double hand_s;   ///< error of the stop watch
  int decimals;
};

/// Ten metres at five forces, with `runs` runs each.
std::string surge_text(std::uint64_t seed, int runs, const Timing& timing) {
  Random random(seed, 0);
  std::string text = "tau_speed,distance_m,elapsed_s\n";
  for (int i = 0; i < runs; ++i) {
    for (const double tau : {0.6, 1.0, 1.4, 1.8, 2.2}) {
      const double time_s = 11.0 / tau * (1.0 + timing.scatter * random.normal());
      text += fmt::format("{},10,{:.{}f}\n", tau, time_s + timing.hand_s * random.normal(),
                          timing.decimals);
    }
  }
  return text;
}

/// Messages of `repeated-rows`; there is at most one.
template <class Reader>
std::string findings_of(Reader read, const std::string& text) {
  std::string messages;
  for (const Finding& one : accepted(read, text).findings) {
    if (one.code != "repeated-rows") continue;
    EXPECT_EQ(messages, "");
    EXPECT_EQ(one.severity, Severity::kWarning);
    messages = fmt::format("{}: {}", one.line, one.message);
  }
  return messages;
}

/// The table with its rows duplicated.
std::string copied(const std::string& text) { return text + text.substr(text.find('\n') + 1); }

TEST(RepeatedRows, ADuplicatedTableIsNamedWithItsLines) {
  // With times to 0.01 s and a scatter s of 0.3 % of 5 to 18 s, 0.7 of five pairs of runs have
  // equal times by chance.
  const std::string table = surge_text(1, 1, {0.005, 0.0, 2});
  EXPECT_EQ(findings_of(read_surge, table), "");
  EXPECT_THAT(findings_of(read_surge, copied(table)),
              AllOf(HasSubstr("7: 5 of 10 rows repeat an earlier row"),
                    HasSubstr("(lines 7, 8, 9, 10, 11)"), HasSubstr("elapsed_s")));
}

TEST(RepeatedRows, ACopyToTheMillisecondIsNamed) {
  // s = 0.3 % of 100 s: two runs are equal to 1 ms with probability 0.28 0.001/0.3 = 0.0009.
  const std::string text = "tau_speed,distance_m,elapsed_s\n0.2,10,100.123\n0.4,10,50.456\n";
  EXPECT_THAT(findings_of(read_surge, text + "0.2,10,100.123\n"), HasSubstr("1 of 3 rows"));
  EXPECT_EQ(findings_of(read_surge, text + "0.2,10,100.124\n"), "");
  // An equal time at another force is another run.
  EXPECT_EQ(findings_of(read_surge, text + "0.3,10,100.123\n"), "");
  // An equal time with a different speed is another run, too.
  EXPECT_EQ(findings_of(read_surge,
                        "tau_speed,distance_m,elapsed_s,speed_mps\n0.2,10,100.123,0.1\n"
                        "0.2,10,100.123,0.11\n"),
            "");
}

TEST(RepeatedRows, ASingleCopyIsNamedWhereItIsLessLikelyThanOneInAHundred) {
  // Two readings with s = 0.003 t, rounded to q = 1 ms, are equal with probability q/(2 s sqrt(pi))
  // = 0.094 s/t: 1 in 100 at 9.4 s.
  EXPECT_THAT(findings_of(read_surge, "tau_speed,distance_m,elapsed_s\n1,10,9.913\n1,10,9.913\n"),
              HasSubstr("1 of 2 rows"));
  EXPECT_EQ(findings_of(read_surge, "tau_speed,distance_m,elapsed_s\n1,10,8.913\n1,10,8.913\n"),
            "");
  // Three pairs of runs, times of 10 s to 0.1 s: a = 0.1/(2 0.03) = 5/3. A pair is equal by chance
  // with p = erf(a) - (1 - exp(-a^2))/(a sqrt(pi)) = 0.664; the expected number of equal pairs is 3
  // p = 1.99, and the Poisson probability of 3 or more is 0.32. At 400 s these are 0.0235, 0.071
  // and 6e-5.
  EXPECT_EQ(findings_of(read_surge,
                        "tau_speed,distance_m,elapsed_s\n1,10,10.1\n1,10,10.1\n1.1,10,9.9\n"
                        "1.1,10,9.9\n1.2,10,9.8\n1.2,10,9.8\n"),
            "");
  EXPECT_THAT(findings_of(read_surge,
                          "tau_speed,distance_m,elapsed_s\n1,10,400.1\n1,10,400.1\n"
                          "1.1,10,399.9\n1.1,10,399.9\n1.2,10,399.8\n1.2,10,399.8\n"),
              HasSubstr("3 of 6 rows"));
}

TEST(RepeatedRows, TurnsAndStopsAreEvaluatedAsWell) {
  const std::string turns =
      "steering_deg,wheel_force,turns,elapsed_s\n10,0.35,2,142.613\n"
      "15,0.35,2,83.081\n20,0.35,2,58.741\n";
  EXPECT_EQ(findings_of(kReadTurning, turns), "");
  EXPECT_THAT(findings_of(kReadTurning, copied(turns)), HasSubstr("3 of 6 rows"));
  // A turn to the other side in the same time is another run.
  EXPECT_EQ(findings_of(kReadTurning, turns + "-10,0.35,2,142.613\n"), "");
  const std::string stops =
      "initial_speed_mps,stop_time_s\n1.66,0.573\n1.2,0.512\n0.9,0.468\n0.5,0.391\n";
  const auto stop_times = [](const std::string& text) {
    const ScratchFile file("trial.csv", text);
    std::vector<Finding> findings;
    EXPECT_TRUE(read_coastdown(file.path(), {}, findings));
    return ::testing::PrintToString(codes_of(findings));
  };
  EXPECT_THAT(stop_times(stops), Not(HasSubstr("repeated-rows")));
  EXPECT_THAT(stop_times(copied(stops)), HasSubstr("repeated-rows@6"));
}

TEST(RepeatedRows, CoarseReadingsAgreeByChance) {
  // Times are rounded to 0.1 s, speeds to two decimals. With a scatter of 0.3 %, half of all pairs
  // of runs have equal readings by chance.
  EXPECT_EQ(findings_of(read_surge,
                        "tau_speed,distance_m,elapsed_s\n1,10,13.9\n1,10,13.9\n1.4,10,9.3\n"
                        "1.4,10,9.3\n2,10,6\n2,10,6\n"),
            "");
  EXPECT_EQ(findings_of(read_surge, "tau_speed,speed_mps\n1,0.72\n1,0.72\n1.4,1.03\n1.4,1.03\n"),
            "");
  // A speed computed from such times has more digits, but its resolution is no finer.
  EXPECT_EQ(findings_of(read_surge,
                        "tau_speed,speed_mps\n1,0.719424460431655\n1,0.719424460431655\n"
                        "1.4,1.07526881720430\n1.4,1.06382978723404\n"),
            "");
}

TEST(RepeatedRows, GoodTablesAreNamedInOneOfAHundredAtTheMost) {
  const Timing timings[] = {{0.005, 0.0, 3}, {0.003, 0.0, 3}, {0.01, 0.0, 3}, {0.003, 0.0, 2},
                            {0.005, 0.1, 2}, {0.005, 0.1, 1}, {0.005, 0.0, 1}};
  int messages = 0;
  int tables = 0;
  for (const Timing& timing : timings) {
    for (const int runs : {1, 2, 4, 8}) {
      for (std::uint64_t seed = 1; seed <= 50; ++seed, ++tables) {
        messages += findings_of(read_surge, surge_text(seed, runs, timing)).empty() ? 0 : 1;
      }
    }
  }
  EXPECT_LE(messages, tables / 100);
}

TEST(RepeatedRows, AHalfOfCopiesIsNamedWhereTimesAreFine) {
  for (const Timing& timing : {Timing{0.005, 0.0, 3}, Timing{0.005, 0.1, 2}}) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      EXPECT_NE(findings_of(read_surge, copied(surge_text(seed, 2, timing))), "") << seed;
    }
  }
}

}  // namespace
}  // namespace awmr::testing::repeated_rows_test
