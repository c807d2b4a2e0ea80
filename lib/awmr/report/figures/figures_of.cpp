#include "awmr/report/figures/figures_of.h"

#include <set>

#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::size_t kMaxNameBytes = 100;

/// Makes equal names of figures unique by a number: path_a, path_a_2.
void number_equal_names(std::vector<Figure>& figures) {
  std::set<std::string> taken;
  for (Figure& figure : figures) {
    const std::string name = figure.name;
    for (int count = 2; !taken.insert(figure.name).second; ++count) {
      figure.name = name + "_" + std::to_string(count);
    }
  }
}

/// Calls `add` for the data of a file. Error (input) if the file does not have awmr's format.
Status add_from_file(void (*add)(const Json&, FiguresOfResults&), const std::string& file,
                     const Json& data, FiguresOfResults& all) {
  try {
    add(data, all);
  } catch (const Json::exception& error) {
    return input_error(
        ErrorCode::kBrokenFile, file,
        std::string("does not have awmr's format (") + error.what() + "); create it again");
  }
  return {};
}

}  // namespace

std::string figure_name(const std::string& kind, const std::string& name) {
  std::string text = kind + "_";
  for (const char c : first_characters(name, kMaxNameBytes)) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    text += letter || is_digit(c) || c == '-' || c == '_' ? c : '_';
  }
  return text;
}

Result<FiguresOfResults> figures_of(const ReportData& data) {
  FiguresOfResults all;
  add_identification_figures(data.model, all);
  AWMR_RETURN_IF_ERROR(add_from_file(add_log_figures, "validation.json", data.json, all));
  AWMR_RETURN_IF_ERROR(add_from_file(add_tuning_figures, "gains.json", data.json, all));
  add_run_figures(data.json, all);
  AWMR_RETURN_IF_ERROR(add_from_file(add_comparison_figures, "comparison.json", data.json, all));
  number_equal_names(all.figures);
  return all;
}

}  // namespace awmr
