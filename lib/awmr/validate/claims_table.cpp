#include <fmt/format.h>

#include <algorithm>

#include "awmr/validate/text.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

std::string verdict_of(const Claim& claim) {
  return claim.reproduced ? "reproduced" : "not reproduced";
}

std::string holds_in(const std::vector<ClaimCase>& cases) {
  const auto reproduced = std::count_if(cases.begin(), cases.end(),
                                        [](const ClaimCase& open) { return open.reproduced; });
  return fmt::format("{} of {}", reproduced, cases.size());
}

/// Text such as "holds in 4 of 24 (differential 24 of 24, ...); decided by allocation (4 of 12)".
/// Empty if the claim was not evaluated over the settings that the paper leaves open.
std::string over_open_cases(const Claim& claim) {
  if (claim.cases.empty()) return {};
  std::string modes;
  for (const ClaimInMode& one : claim.modes) {
    modes +=
        fmt::format("{}{} {}", modes.empty() ? "" : ", ", name_of(one.mode), holds_in(one.cases));
  }
  return fmt::format("holds in {}{}{}", holds_in(claim.cases),
                     modes.empty() ? "" : " (" + modes + ")",
                     claim.decided_by.empty() ? "" : "; decided by " + claim.decided_by);
}

/// Escapes '|', which would end a cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
    text.insert(at, 1, '\\');
  }
  return text;
}

}  // namespace

std::string claims_table(const std::vector<Claim>& claims) {
  std::string text;
  for (const Claim& claim : claims) {
    text += fmt::format("{:<4} {:<15} {}\n", claim.id, verdict_of(claim), claim.statement);
    text += wrapped("found: " + claim.figure, 5);
    text += wrapped("counts as reproduced: " + claim.tolerance, 5);
    text += wrapped("why: " + claim.why, 5);
    if (const std::string open = over_open_cases(claim); !open.empty()) {
      text += wrapped("over the settings that the paper leaves open: " + open, 5);
    }
  }
  const auto reproduced = std::count_if(claims.begin(), claims.end(),
                                        [](const Claim& claim) { return claim.reproduced; });
  return text + fmt::format("{} of {} claims reproduced\n", reproduced, claims.size());
}

std::string claims_markdown(const std::vector<Claim>& claims, std::string_view made_by) {
  std::string text = fmt::format(
      "# The paper's claims, simulated\n\n"
      "Made by `{}` with the model identified from the paper's tables\n"
      "and the paper's gains; the runs are those of `configs/paper/scenarios`. The last column is "
      "over "
      "all\ncombinations of the settings that the paper leaves open: the allocation exact or for "
      "small angles, "
      "F' in [-1, 1],\n[0, 1] or [0, 0.5], m' as identified or as large as a tyre's friction of "
      "0.8 "
      "demands, the moment of the\ncombined mode redistributed or in fixed halves. \"Decided by "
      "allocation (4 of 12)\": in 4 of the 12\ncombinations of the other settings the allocation "
      "alone changes the verdict.\n\n"
      "| claim | verdict | found | counts as reproduced | why | over all open settings |\n"
      "|---|---|---|---|---|---|\n",
      made_by);
  for (const Claim& claim : claims) {
    text += fmt::format("| {}: {} | {} | {} | {} | {} | {} |\n", claim.id, cell(claim.statement),
                        verdict_of(claim), cell(claim.figure), cell(claim.tolerance),
                        cell(claim.why), over_open_cases(claim));
  }
  return text;
}

}  // namespace awmr
