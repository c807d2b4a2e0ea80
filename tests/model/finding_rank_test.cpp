#include "awmr/model/finding_rank.h"

#include <gmock/gmock.h>

namespace awmr {
namespace {

using ::testing::ElementsAre;

TEST(FindingRank, PutsFirstWhatChangesTheNumbersMost) {
  const std::vector<Finding> findings{{"", 0, Severity::kNote, "rows-set-aside", ""},
                                      {"", 0, Severity::kWarning, "assumed-sway", ""},
                                      {"", 0, Severity::kWarning, "outlier", "1"},
                                      {"", 0, Severity::kWarning, "outlier", "2"},
                                      {"", 0, Severity::kWarning, "command-held", ""},
                                      {"", 0, Severity::kWarning, "log-contradiction", ""},
                                      {"", 0, Severity::kWarning, "no-interval", ""},
                                      {"", 0, Severity::kError, "not-timed", ""}};
  std::vector<std::string> codes;
  for (const Finding* finding : by_effect(findings)) {
    codes.push_back(finding->code + finding->message);
  }
  EXPECT_THAT(codes, ElementsAre("not-timed", "no-interval", "log-contradiction", "outlier1",
                                 "command-held", "assumed-sway", "outlier2", "rows-set-aside"));
}

}  // namespace
}  // namespace awmr
