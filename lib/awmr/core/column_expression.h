/// Arithmetic over the columns of a file: `(left + right)/2*0.1`. Private to the library.
///
/// Numbers, names, + - * / ^ ( ), pi and the functions sin cos tan asin acos atan atan2 sqrt abs
/// min max exp ln log10 sign. A bare name has letters, digits, '_' and '.', with an index as in
/// `output[0]`; any other name is quoted or in backticks: `wheel speed/left`.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace awmr {

/// An expression, checked and compiled once, evaluated for every row.
class ColumnExpression {
 public:
  /// Maximum length of the text, in bytes.
  static constexpr std::size_t kLongest = 1000;

  /// Errors, as text: too long; a character or function that is not listed above (this excludes
  /// assignments, comparisons, strings and lists); not a formula.
  static tl::expected<ColumnExpression, std::string> parse(std::string_view text);

  ColumnExpression(ColumnExpression&&) noexcept;
  ColumnExpression& operator=(ColumnExpression&&) noexcept;
  ~ColumnExpression();

  /// Names of the columns, each once, in order of first use; empty for a constant.
  const std::vector<std::string>& names() const { return names_; }
  /// The value, which may be infinite or NaN. `values` are those of names(), in their order.
  double operator()(std::span<const double> values);

 private:
  struct Compiled;
  ColumnExpression(std::vector<std::string> names, std::unique_ptr<Compiled> compiled);
  std::vector<std::string> names_;
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace awmr
