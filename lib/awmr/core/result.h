/// Errors as return values. A failure that a user can cause is returned as an `Error`, with its
/// place, its cause and the remedy. Errors in the program itself fail an assert().
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "awmr/core/error_code.h"

namespace awmr {

/// One fault, at one place.
struct Fault {
  ErrorCode code;
  std::string place;    ///< `FILE:LINE:COLUMN`, `FILE:/json/pointer`, `FILE`, or empty
  std::string message;  ///< the problem, the value that was found, the remedy
};

/// Maximum number of faults collected from a file.
inline constexpr std::size_t kMaxFaults = 100;

/// Kind of an error, which determines the exit code.
enum class ErrorKind {
  kInput,    ///< the command line, a file or a value is wrong (exit code 2)
  kRefused,  ///< the command ran, with a negative result (exit code 1)
  kFault,    ///< internal error of the program (exit code 3)
};

struct Error {
  ErrorKind kind = ErrorKind::kInput;
  std::vector<Fault> faults;  ///< all faults found; never empty
};

/// A value or an error.
template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

/// Makes an error of kind kInput, to be returned from a function that returns a Result:
/// `return input_error(ErrorCode::kWrongType, "a.csv:3:7", "...");`
tl::unexpected<Error> input_error(ErrorCode code, std::string place, std::string message);
/// Makes an error of kind kRefused.
tl::unexpected<Error> refusal(ErrorCode code, std::string message);
/// Makes an error of kind kFault.
tl::unexpected<Error> program_fault(std::string message);
/// Makes an error of kind kInput with several faults. Precondition: `faults` is not empty.
tl::unexpected<Error> input_errors(std::vector<Fault> faults);

/// One line per fault: `error: PLACE: MESSAGE [CODE]`. Shortened as by shown_faults()
/// (option_text.h). Option names are spelt as by spell_options() with `prefix`.
std::string to_text(const Error& error, std::string_view prefix = "");

/// Exit code of a program that ends with this error: that of its ErrorKind.
int exit_code(const Error& error);

}  // namespace awmr

/// If the expression is an error, the function that contains these macros returns it.
///
///     AWMR_RETURN_IF_ERROR(write_file(path, text));
///     AWMR_ASSIGN_OR_RETURN(const Model model, read_model(path));
///
/// AWMR_ASSIGN_OR_RETURN declares a variable, so it cannot be the only statement of an `if`.
#define AWMR_RETURN_IF_ERROR(expression)                                      \
  do {                                                                        \
    if (auto awmr_status = (expression); !awmr_status) {                      \
      return ::tl::unexpected<::awmr::Error>(std::move(awmr_status).error()); \
    }                                                                         \
  } while (false)
#define AWMR_ASSIGN_OR_RETURN(declaration, expression) \
  AWMR_ASSIGN_OR_RETURN_AS(AWMR_JOIN(awmr_result_, __LINE__), declaration, expression)
#define AWMR_ASSIGN_OR_RETURN_AS(result, declaration, expression)                 \
  auto result = (expression);                                                     \
  if (!result) return ::tl::unexpected<::awmr::Error>(std::move(result).error()); \
  declaration = std::move(*result)
#define AWMR_JOIN(left, right) AWMR_JOIN_EXPANDED(left, right)
#define AWMR_JOIN_EXPANDED(left, right) left##right
