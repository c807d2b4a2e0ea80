/// Arithmetic over the columns of a file: `(left + right)/2*0.1`. Private to the library.
///
/// Numbers, names, + - * / ^ ( ), pi and the functions sin cos tan asin acos atan atan2 sqrt abs min
/// max exp ln log10 sign. A name is made of letters, digits, '_' and '.', with an index as in
/// `output[0]`; any other stands in backticks or quotes: `wheel speed/left`.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace awmr {

/// An expression that was checked and compiled once; evaluated for every row.
class ColumnExpression {
 public:
  /// The longest text, in bytes.
  static constexpr std::size_t kLongest = 1000;

  /// Errors, as a text: too long; a character or function that is not of the list above (which
  /// leaves out assignments, comparisons, texts and lists); not a formula.
  static tl::expected<ColumnExpression, std::string> parse(std::string_view text);

  ColumnExpression(ColumnExpression&&) noexcept;
  ColumnExpression& operator=(ColumnExpression&&) noexcept;
  ~ColumnExpression();

  /// The columns by name, each once, in the order of their first use; none in a constant.
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
