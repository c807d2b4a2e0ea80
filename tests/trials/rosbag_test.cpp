/// ROS 2 bags: the usual messages, invalid bags, split bags, tables with one topic each.
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <filesystem>

#include "awmr/trials/formats/ros_message.h"
#include "awmr/trials/log_files.h"
#include "awmr/trials/read_trials.h"
#include "binary_text.h"
#include "support/process.h"
#include "trial_text.h"

namespace awmr::testing::rosbag_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct BagMessage {
  int topic;
  std::int64_t time_ns;
  std::string bytes;
};
struct BagTopic {
  int id;
  std::string name;
  std::string type;
};

/// Writes a bag in the layout of rosbag2; `more` is SQL executed at the end.
void write_bag(const std::filesystem::path& path, const std::vector<BagTopic>& topics,
               const std::vector<BagMessage>& messages, const std::string& more = "") {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  std::string sql =
      "BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER "
      "NOT NULL, data BLOB NOT NULL);";
  for (const BagTopic& topic : topics) {
    sql += "INSERT INTO topics VALUES(" + std::to_string(topic.id) + ",'" + topic.name + "','" +
           topic.type + "','cdr','');";
  }
  for (const BagMessage& message : messages) {
    std::string hex;
    for (const char c : message.bytes) {
      char digits[3];
      std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned char>(c));
      hex += digits;
    }
    sql += "INSERT INTO messages(topic_id, timestamp, data) VALUES(" +
           std::to_string(message.topic) + "," + std::to_string(message.time_ns) + ",x'" + hex +
           "');";
  }
  sql += "COMMIT;" + more;
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
  sqlite3_close(database);
}

std::string odometry(double x, double v, double r) {
  return Cdr()
      .header()
      .text("base")
      .add(x)
      .zeros(6)
      .zeros(36)
      .add(v)
      .zeros(4)
      .add(r)
      .zeros(36)
      .bytes();
}
std::string ackermann(float angle) {
  return Cdr().header().add(angle).add(0.0F).add(1.0F).add(0.0F).add(0.0F).bytes();
}

TEST(RosMessage, TakesTheNumbersOfTheUsualTypes) {
  EXPECT_THAT(*ros_values("std_msgs/msg/Float64", Cdr().add(1.25).bytes()), ElementsAre(1.25));
  EXPECT_THAT(*ros_values("std_msgs/msg/Float32", Cdr().add(1.25F).bytes()), ElementsAre(1.25));
  const auto twist = ros_values("geometry_msgs/msg/TwistStamped",
                                Cdr().header().add(1.0).zeros(4).add(2.0).bytes());
  ASSERT_TRUE(twist);
  EXPECT_THAT(*twist, ElementsAre(1.0, 0.0, 0.0, 0.0, 0.0, 2.0));
  const auto odom = ros_values("nav_msgs/msg/Odometry", odometry(3.0, 1.5, -0.5));
  ASSERT_TRUE(odom);
  EXPECT_EQ((*odom)[0], 3.0);
  EXPECT_EQ((*odom)[7], 1.5);
  EXPECT_EQ((*odom)[12], -0.5);
  EXPECT_EQ(ros_fields("nav_msgs/msg/Odometry")->at(12), "twist.twist.angular.z");
  const auto imu = ros_values(
      "sensor_msgs/msg/Imu",
      Cdr().header().zeros(3).add(1.0).zeros(9).zeros(2).add(0.25).zeros(9).zeros(12).bytes());
  ASSERT_TRUE(imu);
  EXPECT_EQ((*imu)[6], 0.25);
  EXPECT_EQ((*ros_values("ackermann_msgs/msg/AckermannDriveStamped", ackermann(0.125F)))[0], 0.125);
}

TEST(RosMessage, TakesBigEndian) {
  EXPECT_THAT(*ros_values("std_msgs/msg/Float32", std::string("\0\0\0\0\x3F\xC0\0\0", 8)),
              ElementsAre(1.5));
}

TEST(RosMessage, RefusesWhatIsTooShortOrOfAnotherEncoding) {
  const std::string whole = odometry(1.0, 1.0, 1.0);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(ros_values("nav_msgs/msg/Odometry", whole.substr(0, size))) << size;
  }
  EXPECT_TRUE(ros_values("nav_msgs/msg/Odometry", whole));
  EXPECT_FALSE(ros_values("std_msgs/msg/Float32", std::string("\0\7\0\0\0\0\0\0", 8)));
  const std::string lying = Cdr().add(1).add(2u).add(std::uint32_t{0xFFFFFFFF}).zeros(20).bytes();
  EXPECT_FALSE(ros_values("geometry_msgs/msg/TwistStamped", lying));
  EXPECT_FALSE(ros_fields("std_msgs/msg/String"));
}

class Bag : public ::testing::Test {
 protected:
  const std::vector<BagTopic> topics_ = {{1, "/cmd", "ackermann_msgs/msg/AckermannDriveStamped"},
                                         {2, "/wheel/odom", "nav_msgs/msg/Odometry"},
                                         {3, "/left", "std_msgs/msg/Float32"},
                                         {4, "/chatter", "std_msgs/msg/String"}};
  static std::vector<BagMessage> messages(int begin, int end) {
    constexpr std::int64_t kEpoch_ns = 1'795'283'286'000'000'000;
    std::vector<BagMessage> all;
    for (int i = begin; i < end; ++i) {
      const std::int64_t t = kEpoch_ns + 20'000'000LL * i;
      if (i % 2 == 0) all.push_back({1, t, ackermann(0.1F)});
      all.push_back({2, t + 1, odometry(0.1 * i, 1.0 + 0.001 * i * i, 0.2 + 0.002 * i * i)});
      if (i % 4 == 0) all.push_back({3, t + 2, Cdr().add(0.25F).bytes()});
      all.push_back({4, t + 3, "whatever"});
    }
    return all;
  }
  const TrialOptions options_{
      .columns = {*parse_column("force_left=left.data"), *parse_column("force_right=left.data"),
                  *parse_column("steering_cmd_deg=cmd.drive.steering_angle*180/pi"),
                  *parse_column("speed_mps=wheel/odom.twist.twist.linear.x"),
                  *parse_column("yaw_rate_radps=`wheel/odom.twist.twist.angular.z`*1")}};
  Result<DrivingLog> read(const std::filesystem::path& path) {
    findings_.clear();
    return read_log(path, options_, findings_);
  }
  TemporaryDirectory directory_;
  std::vector<Finding> findings_;
};

TEST_F(Bag, IsReadAsALog) {
  const auto path = directory_.path() / "a.db3";
  write_bag(path, topics_, messages(0, 80));
  const auto log = read(path);
  ASSERT_TRUE(log) << to_text(log.error());
  // The first of 80 speeds comes before the first wheel command, so 79 remain.
  EXPECT_EQ((*log)[LogChannel::kSpeed]->fresh_count, 79);
  EXPECT_NEAR(log->t_s.back() - log->t_s.front(), 79 * 0.02, 1e-6);
  EXPECT_EQ(log->force_left[50], 0.25);
  EXPECT_THAT(codes_of(findings_), AllOf(Contains("topics-unread@0"), Contains("bag-time@0"),
                                         Contains("joined-by-time@0")));
}

TEST_F(Bag, InPartsIsOneLog) {
  write_bag(directory_.path() / "a_0.db3", topics_, messages(0, 40));
  write_bag(directory_.path() / "a_1.db3", topics_, messages(40, 80), "PRAGMA journal_mode=WAL;");
  EXPECT_THAT(*files_of(directory_.path()),
              ElementsAre(directory_.path() / "a_0.db3", directory_.path() / "a_1.db3"));
  const auto log = read(directory_.path());
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_EQ((*log)[LogChannel::kSpeed]->fresh_count, 79);
}

TEST_F(Bag, RefusesMalformedContent) {
  const auto path = directory_.path() / "a.db3";
  write_bag(path, topics_, {{2, 1, "short"}});
  EXPECT_THAT(
      to_text(read(path).error()),
      HasSubstr("message 1 of /wheel/odom: its 5 bytes are not a nav_msgs/msg/Odometry in CDR"));
  const std::string whole = read_all(path);
  write_all(path, whole.substr(0, whole.size() / 2));
  EXPECT_THAT(to_text(read(path).error()), HasSubstr("not a readable bag of ROS 2"));
  write_all(path, whole.substr(0, 16));
  EXPECT_THAT(to_text(read(path).error()), HasSubstr("not a readable bag of ROS 2"));
  std::filesystem::remove(path);
  write_bag(path, {}, {}, "DROP TABLE topics;");
  EXPECT_THAT(to_text(read(path).error()), HasSubstr("no such table: topics"));
  std::filesystem::remove(path);
  write_bag(path, {}, {},
            "DROP TABLE topics; CREATE VIEW topics AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL "
            "SELECT id FROM n) SELECT id, 'a' AS name, 'b' AS type, 'cdr' AS "
            "serialization_format FROM n;");
  EXPECT_THAT(to_text(read(path).error()), HasSubstr("not a readable bag of ROS 2"));
}

class Tables : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    write_all(directory_.path() / name, text);
  }
  /// Commands every 50 ms from 0 on, odometry every 20 ms from `begin` on.
  void write_drive(double begin = 0.003) {
    std::string commands = "t_s,force_left,force_right,steering_cmd_deg,stamp\n";
    std::string odometry = "time_ms;v;stamp\n";
    for (int i = 0; i < 40; ++i) commands += std::to_string(0.05 * i) + ",0.1,0.2,3,7\n";
    for (int i = 0; i < 100; ++i) {
      std::string row = std::to_string(1e3 * (begin + 0.02 * i)) + ";" +
                        std::to_string(1.0 + 1e-4 * i * i) + ";7\n";
      for (char& c : row) c = c == '.' ? ',' : c;
      odometry += row;
    }
    write("commands.csv", commands);
    write("odometry.csv", odometry);
  }
  Result<DrivingLog> read(const std::vector<std::string>& mappings) {
    TrialOptions options;
    for (const std::string& text : mappings) options.columns.push_back(*parse_column(text));
    findings_.clear();
    return read_log(directory_.path(), options, findings_);
  }
  TemporaryDirectory directory_;
  std::vector<Finding> findings_;
};

TEST_F(Tables, WithATopicEachAreJoinedByTime) {
  write_drive();
  const auto log = read({"speed_mps=v"});
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_EQ(log->rows(), 140U);
  EXPECT_EQ((*log)[LogChannel::kSpeed]->fresh_count, 100);
  EXPECT_EQ(log->force_right.back(), 0.2);
  EXPECT_EQ(log->mapped, std::vector<std::size_t>{0});
  EXPECT_THAT(codes_of(findings_), AllOf(Contains("csv-format@1"), Contains("time-column@0")));
  EXPECT_TRUE(read({"speed_mps=odometry.v*1"}));
}

TEST_F(Tables, ANameOfTwoFilesNeedsItsFile) {
  write_drive();
  EXPECT_TRUE(read({"speed_mps=odometry.v", "x_m=odometry.stamp"}));
  EXPECT_FALSE(read({"speed_mps=stamp*1"}));
}

TEST_F(Tables, WithoutACommonTimeAreRefused) {
  write_drive(100.0);
  EXPECT_THAT(to_text(read({"speed_mps=v"}).error()), HasSubstr("one clock"));
}

TEST_F(Tables, ThatAllBeginAtZeroAreNoted) {
  write_drive(0.0);
  ASSERT_TRUE(read({"speed_mps=v"}));
  EXPECT_THAT(codes_of(findings_), Contains("one-clock@0"));
}

TEST_F(Tables, NoFileThatCanBeReadIsRefused) {
  write("notes.txt", "nothing");
  EXPECT_THAT(to_text(read({}).error()), HasSubstr("has neither a bag"));
}

}  // namespace
}  // namespace awmr::testing::rosbag_test
