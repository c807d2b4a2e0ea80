/// Formulas over the columns of a file, such as `(left + right)/2*0.1`. Private to the library.
///
/// A formula has numbers, column names, + - * / ^ ( ), pi and the functions sin cos tan asin acos
/// atan atan2 sqrt abs min max exp ln log10 sign. A bare column name has letters, digits, '_' and
/// '.', possibly with an index as in `output[0]`. Any other name must be in double quotes or
/// backticks: "wheel speed/left".
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace awmr {

/// A formula that is checked and compiled once, and then evaluated for every row of a table.
class ColumnExpression {
 public:
  /// Maximum length of the text, in bytes.
  static constexpr std::size_t kLongest = 1000;

  /// Parses a formula. Errors, as text: the formula is longer than kLongest; it has a character or
  /// a function that is not listed above; it is incomplete or malformed.
  static tl::expected<ColumnExpression, std::string> parse(std::string_view text);

  ColumnExpression(ColumnExpression&&) noexcept;
  ColumnExpression& operator=(ColumnExpression&&) noexcept;
  ~ColumnExpression();

  /// Names of the columns that the formula uses, each once, in order of first use.
  const std::vector<std::string>& names() const { return names_; }
  /// Evaluates the formula for the `values` of names(), in the same order. The result may be
  /// infinite or NaN.
  double operator()(std::span<const double> values);

 private:
  struct Compiled;
  ColumnExpression(std::vector<std::string> names, std::unique_ptr<Compiled> compiled);
  std::vector<std::string> names_;
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace awmr
