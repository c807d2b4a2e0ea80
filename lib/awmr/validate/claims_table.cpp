#include <fmt/format.h>

#include <algorithm>

#include "awmr/validate/text.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

std::string verdict_of(const Claim& claim) {
  return claim.reproduced ? "reproduced" : "not reproduced";
}

/// A cell of a Markdown table: '|' would end it.
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
  }
  const auto reproduced = std::count_if(claims.begin(), claims.end(),
                                        [](const Claim& claim) { return claim.reproduced; });
  return text + fmt::format("{} of {} claims reproduced\n", reproduced, claims.size());
}

std::string claims_markdown(const std::vector<Claim>& claims, std::string_view made_by) {
  std::string text = fmt::format(
      "# The paper's claims, simulated\n\n"
      "Made by `{}` with the model identified from the paper's tables\n"
      "and the paper's gains; the runs are those of `configs/paper/scenarios`.\n\n"
      "| claim | verdict | found | counts as reproduced | why |\n|---|---|---|---|---|\n",
      made_by);
  for (const Claim& claim : claims) {
    text +=
        fmt::format("| {}: {} | {} | {} | {} | {} |\n", claim.id, cell(claim.statement),
                    verdict_of(claim), cell(claim.figure), cell(claim.tolerance), cell(claim.why));
  }
  return text;
}

}  // namespace awmr
