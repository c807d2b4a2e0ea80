#include <fmt/format.h>

#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/result.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {
constexpr std::size_t kMaxFaultsShown = 20;
}  // namespace

tl::unexpected<Error> input_error(std::string place, std::string message) {
  return tl::unexpected(Error{ErrorKind::kInput, {{std::move(place), std::move(message)}}});
}

tl::unexpected<Error> refusal(std::string message) {
  return tl::unexpected(Error{ErrorKind::kRefused, {{"", std::move(message)}}});
}

tl::unexpected<Error> program_fault(std::string message) {
  return tl::unexpected(Error{ErrorKind::kFault, {{"", std::move(message)}}});
}

tl::unexpected<Error> input_errors(std::vector<Fault> faults) {
  return tl::unexpected(Error{ErrorKind::kInput, std::move(faults)});
}

std::string to_text(const Error& error) { return to_text(error, ""); }

std::vector<Fault> shown_faults(const std::vector<Fault>& faults) {
  if (faults.size() <= kMaxFaultsShown) return faults;
  std::vector<Fault> shown(faults.begin(), faults.begin() + kMaxFaultsShown);
  const std::size_t left = faults.size() - kMaxFaultsShown;
  shown.push_back(
      {"", fmt::format("{} more fault{} not shown", left, left == 1 ? " is" : "s are")});
  return shown;
}

std::string to_text(const Error& error, std::string_view prefix) {
  std::string text;
  for (const Fault& fault : shown_faults(error.faults)) {
    const std::string message = printable(shortened(spell_options(fault.message, prefix)));
    const std::string place = printable(shortened(spell_options(fault.place, prefix)));
    text += place.empty() ? fmt::format("error: {}\n", message)
                          : fmt::format("error: {}: {}\n", place, message);
  }
  return text;
}

int exit_code(const Error& error) {
  switch (error.kind) {
    case ErrorKind::kInput:
      return 2;
    case ErrorKind::kRefused:
      return 1;
    case ErrorKind::kFault:
      return 3;
  }
  return 3;
}

}  // namespace awmr
