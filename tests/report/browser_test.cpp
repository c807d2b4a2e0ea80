/// The report in a headless browser: on a desktop, on a phone and on paper.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "support/process.h"
#include "support/toolchain.h"

namespace awmr::testing {
namespace {

using ::testing::IsEmpty;
using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kGains = R"({"schema": "awmr.gains/1",
  "heading": {"lambda": 3, "mu": 50, "epsilon": 12}, "speed": {"mu": 5, "epsilon": 1.2}})";
/// Name of a file and of a scenario that contains HTML and script, which the page must not execute.
constexpr const char* kHostileFile = "<img src=x onerror=boom()>";
constexpr const char* kHostileName = R"(</script><script>boom()</script><svg onload=boom()>)";

std::string awmr(const std::string& arguments) {
  return std::string("'") + AWMR_PROGRAM + "' " + arguments + " --quiet";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A report and the width of the frame in which it is opened.
struct FramedPage {
  fs::path report;
  int width = 1280;
};

/// The page, with test scripts, in a frame of its width: the browser's own window is never narrower
/// than 500 px. All frames have the same place, so that none is outside of the window.
std::string in_frame(const FramedPage& framed) {
  std::string page = read_all(framed.report);
  const fs::path source = fs::path(AWMR_SOURCE_DIR) / "tests/report";
  const auto script = [&](const char* name) {
    return "<script>" + read_all(source / name) + "</script>";
  };
  page.insert(page.find("<head>") + 6, script("probe_begin.js"));
  page.insert(page.rfind("</body>"), script("probe_end.js"));
  page = with(with(page, "&", "&amp;"), "\"", "&quot;");
  return "<iframe style=\"position:absolute;top:0;left:0;border:0;height:900px;width:" +
         std::to_string(framed.width) + "px\" srcdoc=\"" + page + "\"></iframe>";
}

std::string browser(const fs::path& profile, const std::string& arguments) {
  return std::string("timeout 120 '") + AWMR_TOOL_CHROMIUM +
         "' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
         "--hide-scrollbars --disable-background-networking --disable-component-update "
         "--disable-sync "
         "--virtual-time-budget=30000 --user-data-dir='" +
         profile.string() + "' " + arguments;
}

/// Values of the attribute data-probe in a text, in order.
std::vector<Json> probes_in(const std::string& text) {
  const std::string mark = " data-probe=\"";
  std::vector<Json> probes;
  for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;) {
    at += mark.size();
    const std::string value = text.substr(at, text.find('"', at) - at);
    probes.push_back(Json::parse(
        with(with(with(with(value, "&quot;", "\""), "&lt;", "<"), "&gt;", ">"), "&amp;", "&")));
  }
  return probes;
}

/// Results of the scripts in each page (probe_end.js). The browser is started once for all of them.
std::vector<Json> looked_at(const std::vector<FramedPage>& pages) {
  const TemporaryDirectory directory;
  std::string frames = "<!doctype html><meta charset=\"utf-8\">";
  for (const FramedPage& page : pages) frames += in_frame(page);
  write_all(directory.path() / "framed.html", frames);
  ProcessResult result;
  // On a busy machine the browser's virtual time can run out before the pages answer.
  for (int attempt = 0; attempt < 3; ++attempt) {
    result = run_process(browser(directory.path() / ("profile" + std::to_string(attempt)),
                                 "--window-size=1400,900 --dump-dom 'file://" +
                                     directory.path().string() + "/framed.html'"));
    std::vector<Json> probes = probes_in(result.out);
    if (probes.size() == pages.size()) return probes;
  }
  throw std::runtime_error("a page did not answer: " + result.out.substr(0, 500));
}

Json looked_at(const fs::path& report, int width) { return looked_at({{report, width}}).front(); }

struct Extent {
  double low = 1e300;
  double high = -1e300;
};

/// Smallest and largest value of a column of a run.
Extent extent_of(const fs::path& csv, std::size_t column) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  Extent extent;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; i <= column; ++i) std::getline(cells, cell, ',');
    extent.low = std::min(extent.low, std::stod(cell));
    extent.high = std::max(extent.high, std::stod(cell));
  }
  return extent;
}

/// Results as `awmr run` leaves them, without tuning: heading steps, the waypoint diamond, and a
/// scenario whose names contain scripts.
class ReportInBrowser : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    const fs::path paper = fs::path(AWMR_SOURCE_DIR) / "configs/paper";
    const auto run = [](const std::string& line) {
      const ProcessResult result = run_process(line, directory_->path());
      ASSERT_LE(result.exit_code, 1) << line << result.err;
    };
    write_all(directory_->path() / "gains.json", kGains);
    const fs::path data = fs::path(AWMR_SOURCE_DIR) / "datasets/paper";
    run(awmr("identify --vehicle '" + (paper / "vehicle.json").string() + "' --surge '" +
             (data / "surge.csv").string() + "' --coastdown '" + (data / "coastdown.csv").string() +
             "' --turning '" + (data / "turning.csv").string() + "' -o model.json"));
    run(awmr("validate --model model.json --gains gains.json -o validation.json"));
    Json validation = Json::parse(read_all(directory_->path() / "validation.json"));
    validation["tyres"] = Json::parse(
        R"({"friction": 0.8, "cornering_stiffness_per_rad": 6.96, "windows": 26, "better": "four-wheel",
            "estimates": {"cornering_stiffness_per_rad": {"value": 6.96, "std_error": 0.1, "ci95": [6.8, 7.2]}},
            "held_out": {"yaw_rate_radps": {"model_rms": 0.111, "four_wheel_rms": 0.0036}}})");
    write_all(directory_->path() / "validation.json", validation.dump());
    const std::string steps = read_all(paper / "scenarios/c3_heading_steps.json");
    Json hostile = Json::parse(steps);
    hostile["name"] = kHostileName;
    write_all(directory_->path() / "scenario_c3_heading_steps.json", steps);
    write_all(directory_->path() / ("scenario_" + std::string(kHostileFile) + ".json"),
              hostile.dump());
    write_all(directory_->path() / "scenario_c8_waypoints.json",
              read_all(paper / "scenarios/c8_waypoints.json"));
    for (const std::string stem : {"c3_heading_steps", "c8_waypoints", kHostileFile}) {
      for (const std::string mode : {"differential", "steering", "combined"}) {
        run(awmr("simulate --model model.json --gains gains.json --scenario 'scenario_" + stem +
                 ".json' --mode " + mode + " -o 'run_" + stem + "_" + mode + "_tuned.csv'"));
      }
    }
    run(
        awmr("compare --model model.json --gains gains.json --samples 5 -o . --scenario "
             "scenario_c3_heading_steps.json --scenario 'scenario_" +
             std::string(kHostileFile) + ".json'"));
    run(awmr("report ."));
  }
  static void TearDownTestSuite() { delete directory_; }
  void SetUp() override { ASSERT_TRUE(found(AWMR_TOOL_CHROMIUM)); }
  static fs::path file(const std::string& name) { return directory_->path() / name; }
  /// looked_at() of the suite's report: on a phone, on a desktop and on a wide screen.
  static const Json& report_at(int width) {
    static const int widths[] = {390, 1280, 1440};
    static const fs::path report = file("report.html");
    static const std::vector<Json> pages =
        looked_at({{report, widths[0]}, {report, widths[1]}, {report, widths[2]}});
    return pages.at(static_cast<std::size_t>(std::ranges::find(widths, width) - widths));
  }
  static inline TemporaryDirectory* directory_ = nullptr;
};

TEST_F(ReportInBrowser, OnADeskAllIsDrawnWithoutErrorsOrRequestsAndNothingIsCut) {
  const Json& page = report_at(1280);
  EXPECT_THAT(page.at("errors"), IsEmpty()) << page.at("errors");
  EXPECT_THAT(page.at("requests"), IsEmpty()) << page.at("requests");
  EXPECT_GT(page.at("charts"), 30);
  EXPECT_EQ(page.at("drawn"), page.at("charts"));
  EXPECT_EQ(page.at("unlabelled"), 0) << "a chart has no label for screen readers";
  EXPECT_THAT(page.at("overflowing"), IsEmpty()) << page.at("overflowing");
  EXPECT_THAT(page.at("clipped"), IsEmpty()) << page.at("clipped");
  EXPECT_THAT(page.at("wide_tables"), IsEmpty()) << page.at("wide_tables");
  EXPECT_LT(fs::file_size(file("report.html")), 3'000'000u);
}

TEST_F(ReportInBrowser, OpensWithASummaryOnOneScreenAndContentsOfEverySection) {
  const Json& page = report_at(1440);
  const Json& summary = page.at("summary");
  EXPECT_LE(summary.at("bottom"), 900) << "pixels of the frame";
  EXPECT_EQ(summary.at("tiles"), 4);
  EXPECT_EQ(summary.at("sketches"), 1);
  EXPECT_EQ(summary.at("charts"), 1);
  EXPECT_THAT(summary.at("symbols"), ::testing::Contains("\u03bb"));
  EXPECT_EQ(page.at("contents").size(), page.at("sections").get<std::size_t>());
  EXPECT_THAT(page.at("contents"), ::testing::Each(true));
  EXPECT_THAT(page.at("orphans"), IsEmpty()) << page.at("orphans");
}

TEST_F(ReportInBrowser, AxesIncludeZeroExtrapolatedTurnsAreShadedAndColoursAreLegible) {
  const Json& page = report_at(1280);
  EXPECT_THAT(page.at("truncated"), IsEmpty()) << page.at("truncated");
  EXPECT_THAT(page.at("shaded"), ::testing::Contains("yaw rate"));
  // Minimum contrasts by WCAG 2.1 AA: criterion 1.4.3 for text, 1.4.11 for graphics.
  EXPECT_GE(page.at("contrasts").at("text"), 4.5);
  EXPECT_GE(page.at("contrasts").at("line"), 3.0);
}

TEST_F(ReportInBrowser, SavesChartsWithoutColoursOfThePage) {
  const Json& page = report_at(1280);
  EXPECT_THAT(page.at("unresolved"), IsEmpty()) << page.at("unresolved");
  EXPECT_THAT(page.at("saved"), ::testing::Each("data:image/png;base64,"));
}

// The time between the heading steps is too short for any mode to settle.
TEST_F(ReportInBrowser, ShowsRunsThatNeverSettled) {
  const TemporaryDirectory directory;
  for (const char* name : {"model.json", "gains.json"})
    fs::copy(file(name), directory.path() / name);
  Json scenario = Json::parse(read_all(file("scenario_c3_heading_steps.json")));
  scenario["duration_s"] = 1;
  scenario["guidance"]["steps"] = Json::parse(
      R"([{"t_s": 0, "psi_deg": 30}, {"t_s": 0.1, "psi_deg": -30}, {"t_s": 0.2, "psi_deg": 90}])");
  write_all(directory.path() / "scenario_close.json", scenario.dump());
  ASSERT_TRUE(succeeded(run_process(awmr("compare --model model.json --gains gains.json -o . "
                                         "--scenario scenario_close.json"),
                                    directory.path())));
  ASSERT_TRUE(succeeded(run_process(awmr("report ."), directory.path())));
  const Json page = looked_at(directory.path() / "report.html", 1280);
  EXPECT_THAT(page.at("errors"), IsEmpty()) << page.at("errors");
  EXPECT_THAT(page.at("never_settled"), ::testing::Contains("never settled"));
}

TEST_F(ReportInBrowser, IsWholeWithoutGainsComparisonOrTurns) {
  const TemporaryDirectory directory;
  const fs::path root = AWMR_SOURCE_DIR;
  ASSERT_LE(run_process(awmr("identify --vehicle '" +
                             (root / "configs/paper/vehicle.json").string() + "' --surge '" +
                             (root / "datasets/paper/surge.csv").string() + "' -o model.json"),
                        directory.path())
                .exit_code,
            1);
  ASSERT_TRUE(succeeded(run_process(awmr("report ."), directory.path())));
  const Json page = looked_at(directory.path() / "report.html", 1440);
  EXPECT_THAT(page.at("errors"), IsEmpty()) << page.at("errors");
  EXPECT_THAT(page.at("orphans"), IsEmpty()) << page.at("orphans");
  EXPECT_EQ(page.at("summary").at("tiles"), 4);
  EXPECT_EQ(page.at("summary").at("charts"), 1);
  EXPECT_THAT(page.at("shaded"), IsEmpty());
}

/// Writes the report of a model into a new folder, in which the firmware's header exists.
FramedPage report_on(const Json& model, const fs::path& folder) {
  fs::create_directory(folder);
  write_all(folder / "model.json", model.dump());
  write_all(folder / "awmr_params.h", "");
  for (const char* step : {"validate --model model.json -o validation.json", "report ."}) {
    EXPECT_TRUE(succeeded(run_process(awmr(step), folder))) << step;
  }
  return {folder / "report.html"};
}

TEST_F(ReportInBrowser, BlockingFindingsAreTheFirstStepsAndTakeTheTickOfTheModel) {
  const TemporaryDirectory directory;
  std::vector<FramedPage> pages;
  const auto add_report = [&](Json model, const Json& finding) {
    if (!finding.is_null()) model["findings"].push_back(finding);
    pages.push_back(report_on(model, directory.path() / std::to_string(pages.size())));
  };
  const auto warning = [](const char* code) {
    return Json{{"file", "surge.csv"},
                {"line", 0},
                {"severity", "warning"},
                {"code", code},
                {"message", "an added finding"}};
  };
  const char* const codes[] = {"no-interval", "model-inadequate", "power-law-inadequate"};
  Json model = Json::parse(read_all(file("model.json")));
  for (const char* code : codes) add_report(model, warning(code));
  add_report(model, nullptr);
  // A fit that has already used another family needs no remedy.
  model["yaw"]["family"] = "coulomb-power";
  model["yaw"]["coulomb"] = {{"value", 1e-6}, {"std_error", nullptr}, {"ci95", nullptr},
                             {"unit", "m"},   {"source", "fitted"},   {"method", "trajectory"}};
  add_report(model, warning("power-law-inadequate"));
  std::vector<Json> summaries;
  for (const Json& page : looked_at(pages)) {
    EXPECT_THAT(page.at("errors"), IsEmpty()) << page.at("errors");
    summaries.push_back(page.at("summary"));
  }
  const auto first_step = [&](std::size_t i) {
    return summaries[i].at("steps").at(0).get<std::string>();
  };
  for (std::size_t i = 0; i < std::size(codes); ++i) {
    EXPECT_EQ(summaries[i].at("tones").at(0), "doubt") << codes[i];
    EXPECT_THAT(first_step(i), ::testing::HasSubstr(codes[i]));
    EXPECT_THAT(first_step(i), ::testing::HasSubstr("identify again"));
  }
  EXPECT_EQ(summaries[3].at("tones").at(0), "good");
  EXPECT_THAT(first_step(3), ::testing::HasSubstr("awmr_params.h"));
  EXPECT_EQ(summaries[4].at("tones").at(0), "good");
}

TEST_F(ReportInBrowser, OnAPhoneNothingIsWiderThanThePageAndItOpensShort) {
  const Json& page = report_at(390);
  EXPECT_THAT(page.at("errors"), IsEmpty()) << page.at("errors");
  EXPECT_EQ(page.at("width"), 390);
  EXPECT_EQ(page.at("scroll_width"), 390);
  EXPECT_THAT(page.at("overflowing"), IsEmpty()) << page.at("overflowing");
  EXPECT_THAT(page.at("clipped"), IsEmpty()) << page.at("clipped");
  EXPECT_THAT(page.at("wide_tables"), IsEmpty()) << page.at("wide_tables");
  EXPECT_LT(page.at("first_height"), 4000) << "each closed section must take one line";
}

// The path turns back in x: a chart that assumes sorted points draws only a part of it.
TEST_F(ReportInBrowser, TheWaypointDiamondHasItsTrueExtentAtEqualAxes) {
  const Json& page = report_at(1280);
  const auto is_diamond = [](const Json& path) { return path.at("waypoints") == 4; };
  const Json& paths = page.at("paths");
  const auto path = std::find_if(paths.begin(), paths.end(), is_diamond);
  ASSERT_NE(path, paths.end());
  // Rows are left out where a line is off by less than 1/2000 of the range of 40 m, and a corner is
  // drawn to some hundredths of a pixel.
  constexpr double kTolerance_m = 0.03;
  const fs::path run = file("run_c8_waypoints_differential_tuned.csv");
  const Extent x = extent_of(run, 1);
  const Extent y = extent_of(run, 2);
  EXPECT_GT(x.high - x.low, 15.0);
  EXPECT_NEAR((*path)["x"][0], x.low, kTolerance_m);
  EXPECT_NEAR((*path)["x"][1], x.high, kTolerance_m);
  EXPECT_NEAR((*path)["y"][0], y.low, kTolerance_m);
  EXPECT_NEAR((*path)["y"][1], y.high, kTolerance_m);
  const double per_metre = (*path)["pixels_per_metre"][0];
  EXPECT_NEAR((*path)["pixels_per_metre"][1], per_metre, 1e-6 * per_metre);
}

TEST_F(ReportInBrowser, HostileNamesAreTextOnThePage) {
  const Json& page = report_at(1280);
  EXPECT_EQ(page.at("foreign_elements"), 0);
  EXPECT_EQ(page.at("booms"), 0);
  EXPECT_TRUE(page.at("shows_hostile_name"));
}

/// Largest difference of a run's column from the page's result, relative to the column's size.
double difference(const fs::path& csv, const Json& columns, const std::string& name) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  std::istringstream head(line);
  std::size_t column = 0;
  for (std::string cell; std::getline(head, cell, ',') && cell != name;) ++column;
  const Json& page = columns.at(name);
  std::size_t row = 0;
  double largest = 0.0;
  double size = 1.0;
  for (; std::getline(file, line); ++row) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; i <= column; ++i) std::getline(cells, cell, ',');
    const double value = std::stod(cell);
    largest = std::max(largest, std::abs(value - page.at(row).get<double>()));
    size = std::max(size, std::abs(value));
  }
  return row == page.size() ? largest / size : 1e300;
}

// The same sources, compiled for another machine: only the last bits of sin, cos and pow differ,
// which a stable loop does not amplify.
TEST_F(ReportInBrowser, TheLivePartComputesWhatTheCommandLineDoes) {
  if (read_all(file("report.html")).find("id=\"wasm\"></script>") != std::string::npos) {
    GTEST_SKIP() << "built without a toolchain for WebAssembly";
  }
  const TemporaryDirectory tuned;
  for (const char* name : {"model.json", "scenario_c3_heading_steps.json"}) {
    fs::copy(file(name), tuned.path() / name);
  }
  write_all(tuned.path() / "tune.json", R"({"global_evaluations": 20, "local_evaluations": 10,
    "draws": 2, "judged_draws": 4, "one_set": true, "scenarios": ["scenario_c3_heading_steps.json"]})");
  for (const char* step :
       {"tune --config tune.json --model model.json -o gains.json",
        "simulate --model model.json --gains gains.json --mode combined -o run.csv "
        "--scenario scenario_c3_heading_steps.json",
        "compare --model model.json --gains gains.json --heading-rate-limit none -o . "
        "--scenario scenario_c3_heading_steps.json",
        "report ."}) {
    ASSERT_TRUE(succeeded(run_process(awmr(step), tuned.path()))) << step;
  }
  const Json page = looked_at(tuned.path() / "report.html", 1280);
  ASSERT_TRUE(page.contains("live")) << page.at("errors");
  constexpr double kTolerance = 1e-9;
  for (const char* name : {"t_s", "psi_rad", "u_mps", "steering_rad", "r_radps"}) {
    EXPECT_LE(difference(tuned.path() / "run.csv", page["live"]["columns"], name), kTolerance)
        << name;
  }
  const auto near = [](const Json& a, const Json& b) {
    const double x = a.get<double>();
    const double y = b.get<double>();
    return std::abs(x - y) <= kTolerance * std::max({1.0, std::abs(x), std::abs(y)});
  };
  const Json gains = Json::parse(read_all(tuned.path() / "gains.json"));
  ASSERT_EQ(page["live"]["constraints"].size(), gains["constraints"].size());
  EXPECT_EQ(page["bars"], 2 * gains["constraints"].size()) << "of the sliders and of the tuning";
  for (std::size_t i = 0; i < gains["constraints"].size(); ++i) {
    const Json& here = gains["constraints"][i];
    const Json& there = page["live"]["constraints"][i];
    EXPECT_EQ(there["name"], here["name"]);
    EXPECT_EQ(there["required"], here["required"]);
    for (const char* key : {"value", "limit", "margin"}) {
      EXPECT_TRUE(near(there[key], here[key])) << here["name"] << key;
    }
  }
  // A slider is moved, the gains are copied and used on the command line.
  const Json& moved = page.at("moved");
  EXPECT_NE(moved["gains"]["heading"]["lambda"], gains["heading"]["lambda"]);
  write_all(tuned.path() / "moved.json", moved["gains"].dump());
  ASSERT_TRUE(succeeded(run_process(
      awmr("simulate --model model.json --gains moved.json --mode combined -o moved.csv "
           "--scenario scenario_c3_heading_steps.json"),
      tuned.path())));
  EXPECT_LE(difference(tuned.path() / "moved.csv", moved["columns"], "psi_rad"), kTolerance);

  const Json comparison = Json::parse(read_all(tuned.path() / "comparison.json"));
  const Json& metrics = comparison["scenarios"][0]["modes"]["combined"]["metrics"];
  for (const auto& [name, value] : page["live"]["metrics"].items()) {
    EXPECT_TRUE(near(value, metrics.at(name).at("nominal"))) << name;
  }
}

TEST_F(ReportInBrowser, PrintsEveryPart) {
  const TemporaryDirectory profile;
  const ProcessResult result = run_process(browser(
      profile.path(), "--no-pdf-header-footer --print-to-pdf='" + file("report.pdf").string() +
                          "' 'file://" + file("report.html").string() + "'"));
  const std::string pdf = read_all(file("report.pdf"));
  ASSERT_TRUE(pdf.starts_with("%PDF")) << result.err;
  std::size_t pages = 0;
  for (std::size_t at = 0; (at = pdf.find("/Type /Page\n", at)) != std::string::npos; ++at) ++pages;
  EXPECT_GT(pages, 8u) << "closed parts are opened for paper";
}

}  // namespace
}  // namespace awmr::testing
