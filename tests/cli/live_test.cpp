/// `awmr live`: a drive that arrives in pieces, through a pipe, a growing file and a serial line,
/// gives an ordinary log and the model that `identify` makes of it.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/program.h"

namespace awmr::testing::live_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kDrive = std::string(AWMR_SOURCE_DIR) + "/datasets/synthetic/drive_1.csv";
const std::string kVehicle = " --vehicle configs/paper/vehicle.json";
/// Parameters that the drive shows accurately enough, so that `awmr live` needs no time to find the
/// next manoeuvre.
const std::string kQuickFit = " --family power --fit surge.alpha,surge.beta,mass_norm";

/// Completes a shell command `{ COMMAND`: after COMMAND, it sends empty lines while there is a
/// reader, like a recorder without data.
const std::string kOnAndOn = "; while echo; do sleep 0.1; done 2>/dev/null; }";

class Live : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  /// Command line of `awmr live`. By default with a fit that takes little time. The tests
  /// APipeInPieces and ATerminal cover all parameters, APipeInPieces also the choice of a family.
  std::string live(const std::string& options, const std::string& fit = kQuickFit) const {
    return std::string(AWMR_PROGRAM) + " live" + kVehicle + fit + " -o " + path("live.json") + " " +
           options;
  }
  /// Runs a shell command from the source directory.
  static ProcessResult shell(const std::string& words) {
    return run_process(words, AWMR_SOURCE_DIR);
  }
  /// Model that `identify` makes of the recording with the same options. Equal recordings are
  /// identified once.
  const std::string& identified(const std::string& options = kQuickFit) {
    const auto [model, is_new] = models_.try_emplace(read_all(path("live.csv")) + options);
    if (is_new) {
      const ProcessResult run = awmr("identify" + kVehicle + " --quiet --log " + path("live.csv") +
                                     " -o " + path("again.json") + " " + options);
      EXPECT_EQ(run.exit_code, 0) << run.err;
      model->second = read_all(path("again.json"));
    }
    return model->second;
  }
  /// Writes the drive with one column scaled and returns its path.
  std::string drive_with(const std::string& column, double factor) const {
    std::istringstream lines(read_all(kDrive));
    std::string text;
    std::size_t place = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("#")) continue;
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (text.empty()) {
        place =
            static_cast<std::size_t>(std::find(cells.begin(), cells.end(), column) - cells.begin());
      } else {
        cells.at(place) = std::to_string(factor * std::stod(cells.at(place)));
      }
      for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + cells[i];
      text += "\n";
    }
    write_all(path("changed.csv"), text);
    return path("changed.csv");
  }

  TemporaryDirectory directory_;
  std::map<std::string, std::string> models_;  ///< by recording and options
};

TEST_F(Live, APipeInPiecesEndsInTheLogAndItsModel) {
  const std::string drive = path("drive.csv");
  shell("head -n 902 " + kDrive + " > " + drive);
  // The stream is split within lines and within numbers.
  const ProcessResult run = shell("{ head -c 20011 " + drive + "; sleep 0.4; tail -c +20012 " +
                                  drive + " | head -c 20000; sleep 0.4; tail -c +40012 " + drive +
                                  "; } | " + live("--log - --every 0.1", ""));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_all(path("live.csv")), read_all(drive));
  EXPECT_EQ(read_all(path("live.json")), identified(""));
  EXPECT_THAT(run.out, AllOf(HasSubstr("surge.alpha"), HasSubstr("the stream ended: 900 rows"),
                             HasSubstr("next: "), HasSubstr("wrote " + path("live.csv"))));
  EXPECT_THAT(run.err, AllOf(HasSubstr(" rows: surge.alpha +-"), HasSubstr("%; next: ")));
  EXPECT_THAT(run.err, Not(HasSubstr("\033"))) << "lines, not a screen";
}

TEST_F(Live, IsReportedOnceInJson) {
  const ProcessResult run = shell("cat " + kDrive + " | " + live("--log - --json --every 0.1"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json.at("command"), "live");
  EXPECT_EQ(json.at("result"), nlohmann::json::parse(read_all(path("live.json"))));
  EXPECT_EQ(json.at("written"), nlohmann::json::array({path("live.csv"), path("live.json")}));
}

TEST_F(Live, AWrongUnitIsReportedDuringTheDrive) {
  const std::string drive = drive_with("speed_mps", 3.6);
  // Sends ten seconds of the drive, then nothing until the finding is reported.
  const ProcessResult run =
      shell("{ head -n 1001 " + drive + "; for i in $(seq 200); do grep -q km/h " +
            path("messages") + " && break; sleep 0.1; done; } | " + live("--log - --every 0.1") +
            " 2> " + path("messages") + "; code=$?; cat " + path("messages") + " >&2; exit $code");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("map it with --column 'speed_mps="), HasSubstr("km/h")));
  EXPECT_LT(run.err.find("speed looks like km/h"), run.err.find("rows are in")) << run.err;
  EXPECT_FALSE(fs::exists(path("live.json")));
  // The recording exists, and the suggested mapping makes a model of it.
  EXPECT_EQ(read_all(path("live.csv")).size(), [&] {
    std::istringstream lines(read_all(drive));
    std::size_t bytes = 0;
    std::string line;
    for (int i = 0; i < 1001 && std::getline(lines, line); ++i) bytes += line.size() + 1;
    return bytes;
  }());
  identified(kQuickFit + " --column 'speed_mps=speed_mps*0.2777778'");
}

TEST_F(Live, AGrowingFileIsFollowedUntilNothingMoreComes) {
  const ProcessResult run =
      shell("head -n 700 " + kDrive + " > " + path("growing.csv") + "; { sleep 0.5; tail -n +701 " +
            kDrive + " >> " + path("growing.csv") + "; } & " +
            live("--log " + path("growing.csv") + " --idle 2 --every 0.2"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_all(path("live.csv")), read_all(kDrive));
  EXPECT_THAT(run.out, HasSubstr("no more data arrived: 1501 rows"));
}

TEST_F(Live, KeepsLogAndModelWhereItsTerminalIsClosed) {
  // Sends SIGHUP twice, because the kernel and the shell each send it when a terminal is closed.
  const ProcessResult run = shell("{ head -n 1400 " + kDrive + kOnAndOn + " | { exec 3<&0; " +
                                  live("--log - --every 0.2") +
                                  " <&3 & pid=$!; sleep 1.5; kill -HUP $pid; sleep 0.1; "
                                  "kill -HUP $pid; wait $pid; }");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("interrupted: 1398 rows"));
  EXPECT_EQ(read_all(path("live.json")), identified());
}

TEST_F(Live, APipeThatNobodyWritesToEndsAtTheDuration) {
  const ProcessResult run =
      shell("mkfifo " + path("pipe") + "; " + live("--log " + path("pipe") + " --duration 1"));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("the duration is over before any data arrived"));
}

TEST_F(Live, EndsAtADurationWithWhatItHas) {
  const ProcessResult run =
      shell("{ head -n 1400 " + kDrive + kOnAndOn + " | " + live("--log - --duration 1.5"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("the duration is over: 1398 rows"));
  EXPECT_EQ(read_all(path("live.json")), identified());
}

TEST_F(Live, AnInterruptionKeepsWhatItHas) {
  for (const std::string signal : {"INT", "TERM"}) {
    fs::remove(path("live.csv"));
    const ProcessResult run =
        shell("mkfifo " + path(signal) + "; { head -n 1400 " + kDrive + kOnAndOn + " > " +
              path(signal) + " & set -m; " + live("--log " + path(signal)) +
              " & sleep 1.5; kill -" + signal + " $!; wait $!");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("interrupted: 1398 rows"));
    EXPECT_EQ(read_all(path("live.json")), identified());
  }
}

TEST_F(Live, EndsIfEnoughOrReportsThatItIsNot) {
  const std::string fit = " --family power --fit surge.alpha";
  const ProcessResult enough = shell("{ head -n 900 " + kDrive + kOnAndOn + " | " +
                                     live("--log - --enough 0.05 --until-enough --every 0.1", fit));
  ASSERT_EQ(enough.exit_code, 0) << enough.err;
  EXPECT_THAT(enough.out, AllOf(HasSubstr("enough was recorded: "),
                                HasSubstr("enough: every half width is within 5 %")));
  EXPECT_EQ(read_all(path("live.json")), identified(fit));
  fs::remove(path("live.csv"));
  const ProcessResult too_few =
      shell("head -n 900 " + kDrive + " | " + live("--log - --enough 1e-6 --until-enough"));
  EXPECT_EQ(too_few.exit_code, 1);
  EXPECT_THAT(too_few.err, AllOf(HasSubstr("[not-enough]"), HasSubstr("surge.alpha +-")));
}

TEST_F(Live, DamagedLinesAreSetAsideAndReported) {
  const ProcessResult run =
      shell("{ echo boot; head -n 700 " + kDrive + "; echo 7.1,0.2; tail -n +701 " + kDrive +
            "; printf 15.1,0.2,0; } | " + live("--log -"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("live.csv:1: 3 of "), HasSubstr("[lines-set-aside]")));
  EXPECT_THAT(read_all(path("live.csv")), AllOf(HasSubstr("# boot\n"), HasSubstr("\n# 7.1,0.2\n"),
                                                HasSubstr("\n# 15.1,0.2,0\n")));
  EXPECT_EQ(read_all(path("live.json")), identified());
}

TEST_F(Live, ASerialLineIsRead) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(::grantpt(terminal), 0);
  ASSERT_EQ(::unlockpt(terminal), 0);
  termios settings{};
  ::tcgetattr(terminal, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(terminal, TCSANOW, &settings);
  const std::string port = ::ptsname(terminal);
  std::thread board([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    const std::string bytes = read_all(kDrive);
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count =
          ::write(terminal, bytes.data() + sent, std::min<std::size_t>(1000, bytes.size() - sent));
      if (count <= 0) break;
      sent += static_cast<std::size_t>(count);
    }
  });
  const ProcessResult run = shell(live("--port " + port + " --baud 115200 --idle 2.5"));
  board.join();
  ::close(terminal);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_all(path("live.csv")), read_all(kDrive));
}

TEST_F(Live, ATerminalShowsOneScreen) {
  const ProcessResult run = shell("TERM=xterm script -qec '{ head -n 900 " + kDrive +
                                  "; sleep 1.2; tail -n +901 " + kDrive + "; sleep 1; } | " +
                                  live("--log - --every 0.5", " --family power") + "' /dev/null");
  EXPECT_THAT(run.out, AllOf(HasSubstr("recording " + path("live.csv")), HasSubstr("Ctrl-C ends"),
                             HasSubstr("\033[J"), HasSubstr("A"), HasSubstr("[#"),
                             HasSubstr("[          ]")));
}

TEST_F(Live, RefusesSourcesThatItCannotRecord) {
  struct Case {
    std::string words;
    std::string error;
  };
  write_all(path("there.csv"), "a recording");
  const Case cases[] = {
      {live("--log /dev/null"), "the stream ended before any data arrived"},
      {live("--log - <&-"), "standard input is closed"},
      {live("--log nowhere.csv"), "nowhere.csv: cannot open the file"},
      {live("--log " + path("")), "this is a directory"},
      {live("--port /dev/null"), "is not a serial port"},
      {live("--port nowhere"), "nowhere: No such file"},
      {live("--port /dev/null --baud 12345"), "--baud: found 12345; expected one of 9600"},
      {live(""), "give the source of the log"},
      {live("--log - --port /dev/null"), "give the source of the log"},
      {live("--log - --record " + path("live.json")), "it is the model's file"},
      {live("--log " + path("there.csv") + " --record " + path("there.csv")), "it is the input"},
      {live("--log - --column speed_mps=V") + " < " + kDrive, "V"}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.words);
    const ProcessResult run = shell(c.words);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr(c.error));
    EXPECT_FALSE(fs::exists(path("live.json")));
  }
  EXPECT_EQ(read_all(path("there.csv")), "a recording");
  // A second recording does not overwrite the first one.
  const ProcessResult again = shell(live("--log -") + " < " + kDrive);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("this recording already exists"));
}

TEST_F(Live, HostileStreamsEndWithinBounds) {
  for (const std::string source :
       {"head -c 30000000 /dev/zero", "head -c 3000000 /dev/urandom", "yes | head -c 300000",
        "echo t_s,speed_mps", "printf 'x%.0s' $(seq 200000)"}) {
    fs::remove(path("live.csv"));
    const ProcessResult run =
        shell("ulimit -v 2097152; ulimit -t 20; " + source + " | " + live("--log - --every 0.2"));
    EXPECT_EQ(run.exit_code, 2) << source << run.err.substr(0, 1000);
    EXPECT_LT(run.err.size(), 100'000U) << source;
  }
}

}  // namespace
}  // namespace awmr::testing::live_test
