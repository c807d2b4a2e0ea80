#include "awmr/report/figures/figures_of.h"

#include <set>

#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::size_t kMostNameBytes = 100;

/// Names that became the same are numbered: path_a, path_a_2.
void number_equal_names(std::vector<Figure>& figures) {
  std::set<std::string> taken;
  for (Figure& figure : figures) {
    const std::string name = figure.name;
    for (int count = 2; !taken.insert(figure.name).second; ++count) {
      figure.name = name + "_" + std::to_string(count);
    }
  }
}

}  // namespace

std::string figure_name(const std::string& kind, const std::string& name) {
  std::string text = kind + "_";
  for (const char c : first_characters(name, kMostNameBytes)) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    text += letter || is_digit(c) || c == '-' || c == '_' ? c : '_';
  }
  return text;
}

Result<FiguresOfResults> figures_of(const ReportData& data) {
  FiguresOfResults all;
  add_identification_figures(data.model, all);
  add_run_figures(data.json, all);
  try {
    add_comparison_figures(data.json, all);
  } catch (const Json::exception& error) {
    return input_error("comparison.json", std::string("is not as awmr compare writes it (") +
                                              error.what() + "); compare again");
  }
  number_equal_names(all.figures);
  return all;
}

}  // namespace awmr
