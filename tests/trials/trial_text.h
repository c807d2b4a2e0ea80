/// Reads trials from a text instead of a file, and lists the readers' findings.
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "awmr/trials/read_trials.h"
#include "support/paper_vehicle.h"
#include "support/scratch_file.h"

namespace awmr::testing {

inline constexpr auto kReadTurning = [](const std::filesystem::path& path,
                                        const TrialOptions& options,
                                        std::vector<Finding>& findings) {
  return read_turning(path, paper_vehicle(), options, findings);
};

template <class Set>
struct Read {
  Set set;
  std::vector<Finding> findings;
};

/// Reads a text that must be accepted; returns the rows and the findings.
template <class Reader>
auto accepted(Reader read, const std::string& text, const TrialOptions& options = {}) {
  const ScratchFile file("trial.csv", text);
  std::vector<Finding> findings;
  auto set = read(file.path(), options, findings);
  if (!set) ADD_FAILURE() << to_text(set.error());
  for (const Finding& finding : findings) EXPECT_EQ(finding.file, file.path().filename().string());
  using Set = typename decltype(set)::value_type;
  return Read<Set>{set ? *set : Set{}, findings};
}

/// Faults with which the reader refuses a text, as `LINE:COLUMN: MESSAGE`; empty if it accepts it.
template <class Reader>
std::vector<std::string> faults_of(Reader read, const std::string& text,
                                   const TrialOptions& options = {}) {
  const ScratchFile file("trial.csv", text);
  std::vector<Finding> findings;
  const auto set = read(file.path(), options, findings);
  std::vector<std::string> faults;
  if (set) return faults;
  EXPECT_EQ(set.error().kind, ErrorKind::kInput);
  const std::string prefix = file.path().string() + ":";
  for (const Fault& fault : set.error().faults) {
    EXPECT_THAT(fault.place, ::testing::StartsWith(prefix)) << fault.message;
    faults.push_back(fault.place.substr(std::min(prefix.size(), fault.place.size())) + ": " +
                     fault.message);
  }
  return faults;
}

/// Returns the text `CODE@LINE` of each finding.
inline std::vector<std::string> codes_of(const std::vector<Finding>& findings) {
  std::vector<std::string> codes;
  for (const Finding& finding : findings) {
    codes.push_back(finding.code + "@" + std::to_string(finding.line));
  }
  return codes;
}

}  // namespace awmr::testing
