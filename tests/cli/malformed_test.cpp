/// Malformed input, one case per line of malformed.txt. The program must end with exit code 2, name
/// the place and the code, write nothing, and use bounded time and memory.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::malformed_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Case {
  int line = 0;       ///< line in malformed.txt
  std::string kind;   ///< malformed input: a file of this kind, or the command line
  std::string edit;   ///< change of a valid file, or a complete command line
  std::string place;  ///< place in the error, after the file's name
  std::string code;   ///< error code
  std::string text;   ///< text in the message: a number, name or suggestion; empty: any
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  for (std::size_t bar = 0; (bar = line.find(" | ", begin)) != std::string::npos; begin = bar + 3) {
    fields.push_back(line.substr(begin, bar - begin));
  }
  fields.push_back(line.substr(begin));
  return fields;
}

std::vector<Case> cases_of(const std::string& kind) {
  std::ifstream table(std::string(AWMR_SOURCE_DIR) + "/tests/cli/malformed.txt");
  std::vector<Case> cases;
  int number = 0;
  for (std::string line; std::getline(table, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> fields = split(line);
    if (fields.size() < 4 || fields.size() > 5) {
      throw std::runtime_error("malformed.txt:" + std::to_string(number));
    }
    if (fields[0] != kind) continue;
    cases.push_back(
        {number, fields[0], fields[1], fields[2], fields[3], fields.size() == 5 ? fields[4] : ""});
  }
  return cases;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Replaces the escapes \n, \r, \t, \\ and \xHH.
std::string unescaped(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      bytes += text[i];
      continue;
    }
    const char c = text.at(++i);
    if (c == 'x') {
      bytes += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      bytes += c == 'n' ? '\n' : c == 'r' ? '\r' : c == 't' ? '\t' : c;
    }
  }
  return bytes;
}

/// `text TEXT` is the whole file; `/pointer = JSON` and `/pointer gone` change the valid one.
std::string edited(const std::string& good, const std::string& edit) {
  if (edit == "text") return "";
  if (edit.starts_with("text ")) return unescaped(edit.substr(5));
  ordered_json json = ordered_json::parse(good);
  if (edit.ends_with(" gone")) {
    const ordered_json::json_pointer pointer(edit.substr(0, edit.size() - 5));
    json.at(pointer.parent_pointer()).erase(pointer.back());
  } else {
    const std::size_t equals = edit.find(" = ");
    json[ordered_json::json_pointer(edit.substr(0, equals))] =
        ordered_json::parse(edit.substr(equals + 3));
  }
  return json.dump(2);
}

constexpr const char* kGains =
    R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12}, "speed": {"mu": 5, "epsilon": 1.2}})";
constexpr const char* kTyres =
    R"({"schema": "awmr.validation/1", "command": "validate", "version": "0", "inputs": [], "options": {},
        "passed": true, "verdict": "", "trials": [], "logs": [], "claims": [], "findings": [],
        "rms_relative_error": {"surge": null, "turning": null, "coastdown": null},
        "tyres": {"friction": 0.6, "cornering_stiffness_per_rad": 7, "windows": 12, "better": "undecided",
                  "estimates": {"friction": {"value": 0.6, "std_error": 0.1, "ci95": [0.5, 0.8]}},
                  "held_out": {"speed_mps": {"model_rms": 0.1, "four_wheel_rms": 0.1}}}})";
constexpr const char* kTune =
    R"({"form": "strict", "margin": 0.8, "weights": {"itae": 1}, "bounds": {"lambda": [0.5, 15]},
        "global_evaluations": 10, "local_evaluations": 5, "seed": 1})";

std::string source(const std::string& path) { return std::string(AWMR_SOURCE_DIR) + "/" + path; }

std::string project_text() {
  ordered_json project = ordered_json::parse(read_all(source("configs/paper/project.json")));
  project["vehicle"] = source("configs/paper/vehicle.json");
  for (auto& [kind, path] : project["trials"].items()) {
    path = source("datasets/paper/" + kind + ".csv");
  }
  project["compare"]["scenarios"] = {source("configs/paper/scenarios/c3_heading_steps.json")};
  return project.dump();
}

/// A kind of input: the extension of its file, and the command that reads it, with @ for the file.
struct Kind {
  std::string name;
  std::string suffix;
  std::string command;
};
const Kind kKinds[] = {{"vehicle", ".json", "identify --vehicle @ --surge SURGE -o OUT"},
                       {"scenario", ".json",
                        "simulate --model MODEL --gains GAINS --scenario @ --mode combined -o OUT"},
                       {"gains", ".json", "emit --model MODEL --gains @ --header-only -o OUT"},
                       {"model", ".json", "emit --model @ --gains GAINS --header-only -o OUT"},
                       {"tyres", ".json",
                        "simulate --model MODEL --gains GAINS --scenario SCENARIO --mode combined "
                        "--plant four-wheel --tyres @ -o OUT"},
                       {"tune", ".json", "tune --model MODEL --config @ -o OUT"},
                       {"project", ".json", "run @ -o OUT"},
                       {"surge", ".csv", "identify --vehicle VEHICLE --surge @ -o OUT"},
                       {"turning", ".csv", "identify --vehicle VEHICLE --turning @ -o OUT"},
                       {"coastdown", ".csv", "identify --vehicle VEHICLE --coastdown @ -o OUT"},
                       {"log", ".csv", "identify --vehicle VEHICLE --log @ -o OUT"},
                       {"awl", ".awl", "log @ -o OUT"},
                       {"field", ".csv", "compass @ -o OUT"},
                       {"command", "", ""}};

class Malformed : public ::testing::TestWithParam<Kind> {
 protected:
  Malformed() {
    for (const char* table : {"surge", "coastdown"}) {
      fs::copy(source(std::string("datasets/paper/") + table + ".csv"), path(table, ".csv"));
    }
    fs::copy(source("configs/paper/vehicle.json"), path("vehicle"));
    fs::copy(source("configs/paper/scenarios/c3_heading_steps.json"), path("scenario"));
    write_all(path("gains"), kGains);
    write_all(path("tune"), kTune);
    write_all(path("tyres"), kTyres);
    write_all(path("project"), project_text());
    const ProcessResult identified =
        awmr("identify --vehicle " + path("vehicle") + " --surge " + path("surge", ".csv") +
             " --coastdown " + path("coastdown", ".csv") +
             " --turning datasets/paper/turning.csv -o " + path("model"));
    if (identified.exit_code != 0) throw std::runtime_error(identified.err);
    for (const auto& entry : fs::directory_iterator(directory_.path())) {
      good_[entry.path().filename().string()] = read_all(entry.path());
    }
  }
  std::string path(const std::string& name, const std::string& suffix = ".json") const {
    return (directory_.path() / (name + suffix)).string();
  }

  /// The command line with the paths inserted.
  std::string with_paths(std::string command, const std::string& bad) const {
    const std::pair<std::string, std::string> places[] = {{"VEHICLE", path("vehicle")},
                                                          {"MODEL", path("model")},
                                                          {"GAINS", path("gains")},
                                                          {"SCENARIO", path("scenario")},
                                                          {"PROJECT", path("project")},
                                                          {"SURGE", path("surge", ".csv")},
                                                          {"COAST", path("coastdown", ".csv")},
                                                          {"OUT", path("out", "")},
                                                          {"@", bad}};
    for (const auto& [word, value] : places) {
      for (std::size_t at = 0; (at = command.find(word, at)) != std::string::npos;) {
        command.replace(at, word.size(), value);
        at += value.size();
      }
    }
    return command;
  }

  /// Runs the program with limits of 10 s of CPU time and 2 GiB, far more than any refusal needs.
  static ProcessResult run_bounded(const std::string& arguments) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    const std::string bounds = "ulimit -t 60; ";  // sanitizers reserve terabytes of addresses
#else
    const std::string bounds = "ulimit -t 10; ulimit -v 2097152; ";
#endif
    return run_process(bounds + AWMR_PROGRAM + " " + arguments, AWMR_SOURCE_DIR);
  }

  /// Existing files are unchanged, and there are no new ones.
  void expect_nothing_written() {
    for (const auto& entry : fs::directory_iterator(directory_.path())) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("bad")) continue;
      const auto good = good_.find(name);
      ASSERT_NE(good, good_.end()) << name << " was written";
      EXPECT_EQ(read_all(entry.path()), good->second) << name << " was changed";
    }
  }

  TemporaryDirectory directory_;
  std::map<std::string, std::string> good_;
};

TEST_P(Malformed, InputIsRefusedByPlaceAndCode) {
  const Kind& kind = GetParam();
  const std::vector<Case> cases = cases_of(kind.name);
  ASSERT_FALSE(cases.empty());
  const std::string bad = path("bad", kind.suffix);
  for (const Case& c : cases) {
    SCOPED_TRACE("malformed.txt:" + std::to_string(c.line) + ": " + c.edit.substr(0, 100));
    std::string command = c.edit;
    if (kind.name != "command") {
      write_all(bad, edited(good_[kind.name + kind.suffix], c.edit));
      command = kind.command;
    }
    const ProcessResult result = run_bounded(with_paths(command, bad));
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(lines_of(result.err),
                Contains(AllOf(StartsWith("error: " + (c.place.empty() ? "" : bad + c.place)),
                               EndsWith(" [" + c.code + "]"), HasSubstr(c.text))))
        << result.err;
    EXPECT_LT(result.err.size(), 20'000U);
    expect_nothing_written();
  }
}

INSTANTIATE_TEST_SUITE_P(Input, Malformed, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return kind.param.name; });

TEST(MalformedTable, HasThreeHundredCases) {
  std::size_t count = 0;
  for (const Kind& kind : kKinds) count += cases_of(kind.name).size();
  EXPECT_GE(count, 300U);
}

}  // namespace
}  // namespace awmr::testing::malformed_test
