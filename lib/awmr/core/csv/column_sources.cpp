#include "awmr/core/csv/column_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/nearest.h"
#include "awmr/core/option_text.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

using Header = std::span<const std::string>;

/// Lists the names for a message: at most 20 names, followed by the number of those left out.
std::string listed(Header names) {
  constexpr std::size_t kMax = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMax); ++i) {
    text += (i == 0 ? "" : ", ") + shortened(names[i], 60);
  }
  if (names.size() > kMax) text += fmt::format(" and {} more", names.size() - kMax);
  return text;
}

/// A mapping, interpreted for the header of one file.
struct Candidate {
  ColumnSource source;
  std::vector<std::string> names;    ///< columns that the mapping uses
  std::vector<std::string> missing;  ///< columns that the mapping uses and the header lacks
};

/// Interprets a mapping for the header of one file: as the first definition of column_mapping.h
/// that this header permits.
Candidate candidate_of(const CsvColumn& column, const ColumnMapping& mapping, Header header) {
  Candidate candidate{
      .source = {.column = column, .indices = {}, .mapping = &mapping}, .names = {}, .missing = {}};
  if (!mapping.expression.empty() && contains(header, mapping.expression)) {
    candidate.names = {mapping.expression};
    return candidate;
  }
  const bool scaled = !mapping.source.empty() && contains(header, mapping.source);
  auto expression = scaled || mapping.expression.empty()
                        ? tl::unexpected(std::string())
                        : ColumnExpression::parse(mapping.expression);
  if (!expression) {
    candidate.source.scale = mapping.scale;
    candidate.source.offset = mapping.offset;
    candidate.names = {mapping.source};
  } else {
    candidate.names = expression->names();
    candidate.source.expression = std::move(*expression);
  }
  for (const std::string& name : candidate.names) {
    if (!contains(header, name)) candidate.missing.push_back(name);
  }
  return candidate;
}

/// Precedence of a mapping: of two mappings that give the same column, the one with the lower
/// number is used. 0: the user gave it for one file, which it names; 1: the user gave it for all
/// files; 2: it is from vehicle.json and applies to all files.
int precedence(const ColumnMapping& mapping) {
  return !mapping.file.empty() ? 0 : mapping.standing ? 2 : 1;
}

std::string shown(const ColumnMapping& mapping) {
  return mapping.expression.empty() ? mapping.source : mapping.expression;
}

/// Searches for the source of one requested column, among its mappings and the columns of the
/// header.
class Search {
 public:
  Search(const CsvColumn& column, Header header, Header samples, ColumnSources& result)
      : column_(column), header_(header), samples_(samples), result_(result) {}

  void consider(const ColumnMapping& mapping) {
    Candidate candidate = candidate_of(column_, mapping, header_);
    if (!candidate.missing.empty()) {
      const bool in_part = candidate.missing.size() < candidate.names.size();
      if (in_part) fault(ErrorCode::kMissing, missing_in(mapping, candidate));
      if (!absent_ || in_part) absent_ = std::move(candidate);
    } else if (!chosen_ || precedence(mapping) < precedence(*chosen_->source.mapping)) {
      chosen_ = std::move(candidate);
    } else if (precedence(mapping) == precedence(*chosen_->source.mapping)) {
      fault(ErrorCode::kGivenTwice,
            fmt::format("two mappings give the column {}: \"{}\" and \"{}\"; keep one",
                        column_.name, shown(*chosen_->source.mapping), shown(mapping)));
    }
  }

  void finish() {
    if (chosen_) {
      use(std::move(chosen_->source), chosen_->names);
    } else if (contains(header_, column_.name)) {
      use({.column = column_, .indices = {}}, {column_.name});
    } else if (column_.name == kTimeName && !absent_ && use_time()) {
      return;
    } else if (column_.required && !faulty_) {
      report_missing();
    }
  }

 private:
  void fault(ErrorCode code, std::string message, std::optional<std::size_t> cell = std::nullopt) {
    faulty_ = true;
    result_.faults.push_back({code, cell, std::move(message)});
  }

  std::string hint(const std::string& name) const {
    if (const std::string near = nearest(name, header_); !near.empty()) {
      return fmt::format("; did you mean \"{}\"?", near);
    }
    return fmt::format("; the header has {}; rename one or map it with {}", listed(header_),
                       option_text(fmt::format("column {}=SOURCE", column_.name)));
  }

  std::string missing_in(const ColumnMapping& mapping, const Candidate& candidate) const {
    return fmt::format("{}={}: the column \"{}\" is missing{}", column_.name,
                       shortened(mapping.expression, 100), candidate.missing.front(),
                       hint(candidate.missing.front()));
  }

  void report_missing() {
    if (!absent_) {
      fault(ErrorCode::kMissing,
            fmt::format("the column {} is missing{}", column_.name, hint(column_.name)));
    } else if (absent_->source.expression) {
      fault(ErrorCode::kMissing, missing_in(*absent_->source.mapping, *absent_));
    } else {
      const std::string& source = absent_->names.front();
      fault(ErrorCode::kMissing, fmt::format("the column \"{}\", mapped to {}, is missing{}",
                                             source, column_.name, hint(source)));
    }
  }

  /// Uses the column that find_time() recognises as the time t_s. Returns false if there is none.
  /// Several candidates are a fault; the result is then true.
  bool use_time() {
    auto time = find_time(header_, samples_);
    if (!time) {
      fault(ErrorCode::kAmbiguous,
            fmt::format("{}; select one: {}", time.error(), option_text("column t_s=EXPRESSION")));
      return true;
    }
    if (!*time) return false;
    ColumnSource source{.column = column_, .indices = {}};
    std::vector<std::string> names{(*time)->expression};
    if (!(*time)->is_date) {
      // A column name that contains a backtick cannot be parsed, because the expression quotes
      // names in backticks.
      auto expression = ColumnExpression::parse((*time)->expression);
      if (!expression) return false;
      names = expression->names();
      source.expression = std::move(*expression);
    }
    source.time = std::move(**time);
    use(std::move(source), names);
    return true;
  }

  /// Adds `source` to the result. `names`: the columns that it uses, whose indices in the header
  /// are stored in `source`. If the header has one of the names twice, adds a fault instead.
  void use(ColumnSource source, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const auto first = std::find(header_.begin(), header_.end(), name);
      const auto second = std::find(first + 1, header_.end(), name);
      if (second != header_.end()) {
        fault(ErrorCode::kGivenTwice,
              fmt::format("the column \"{}\" appears twice in the header; rename or remove one",
                          name),
              static_cast<std::size_t>(second - header_.begin()));
        return;
      }
      source.indices.push_back(static_cast<std::size_t>(first - header_.begin()));
    }
    // A mapping of the time t_s can name a column of dates, which is recognised by its first cell.
    const bool is_one = source.indices.size() == 1 && !source.expression && source.scale == 1.0;
    if (column_.name == kTimeName && source.mapping != nullptr && is_one &&
        source.indices[0] < samples_.size() && seconds_of_date(samples_[source.indices[0]])) {
      source.time = TimeColumn{.expression = names[0],
                               .is_date = true,
                               .meaning = fmt::format("the dates of \"{}\"", names[0])};
    }
    result_.found.push_back(std::move(source));
  }

  const CsvColumn& column_;
  Header header_;
  Header samples_;
  ColumnSources& result_;
  std::optional<Candidate> chosen_ = {};
  std::optional<Candidate> absent_ = {};
  bool faulty_ = false;
};

}  // namespace

ColumnSources find_columns(std::span<const std::string> header,
                           std::span<const std::string> samples, std::span<const CsvColumn> columns,
                           std::span<const ColumnMapping> mappings, const std::string& file) {
  ColumnSources result;
  for (const CsvColumn& column : columns) {
    Search search(column, header, samples, result);
    for (const ColumnMapping& mapping : mappings) {
      if (mapping.name == column.name && is_for(mapping, file)) search.consider(mapping);
    }
    search.finish();
  }
  return result;
}

std::vector<std::string> missing_columns(const ColumnMapping& mapping, Header header) {
  return candidate_of({}, mapping, header).missing;
}

bool is_for(const ColumnMapping& mapping, const std::string& file) {
  return mapping.file.empty() || mapping.file == file ||
         mapping.file == std::filesystem::path(file).filename().string();
}

std::set<std::string> wanted_names(std::span<const CsvColumn> columns,
                                   std::span<const ColumnMapping> mappings) {
  std::set<std::string> names;
  for (const CsvColumn& column : columns) names.insert(column.name);
  for (const ColumnMapping& mapping : mappings) {
    names.insert({mapping.source, mapping.expression});
    const auto expression = ColumnExpression::parse(mapping.expression);
    if (expression) names.insert(expression->names().begin(), expression->names().end());
  }
  return names;
}

}  // namespace awmr
