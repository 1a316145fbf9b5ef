#include "wavetank/node/bag_writer.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <sys/stat.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <vector>

#include "../common/error_of.h"
#include "../common/scratch_directory.h"
#include "wavetank/common/log.h"

namespace wavetank::bag_writer_test {

namespace fs = std::filesystem;

class BagWriterTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_.file(name); }
  static std_msgs::String text(const std::string& data) {
    std_msgs::String message;
    message.data = data;
    return message;
  }
  const ScratchDirectory scratch_;
};

TEST_F(BagWriterTest, WritesUnderATemporaryNameAndRenamesAtTheEnd) {
  BagWriter writer(path("a.bag"), "/wavetank");
  writer.write("note", ros::Time(0.5), text("hello"));
  EXPECT_FALSE(fs::exists(path("a.bag")));
  EXPECT_TRUE(fs::exists(path("a.bag.active")));
  writer.finish();
  EXPECT_TRUE(fs::exists(path("a.bag")));
  EXPECT_FALSE(fs::exists(path("a.bag.active")));
  EXPECT_THROW(writer.write("note", ros::Time(1.0), text("late")), Error);
}

TEST_F(BagWriterTest, ReadsBackWithTopicsTimesAndLatching) {
  {
    BagWriter writer(path("a.bag"), "/wavetank");
    writer.write("note", ros::Time(0, 0), text("at zero"));
    writer.write_latched("/case", ros::Time(0.5), text("kept"));
    writer.finish();
  }
  rosbag::Bag bag(path("a.bag"));
  rosbag::View view(bag);
  std::vector<std::string> topics;
  for (const rosbag::MessageInstance& entry : view) topics.push_back(entry.getTopic() + "=" + entry.instantiate<std_msgs::String>()->data);
  EXPECT_EQ(topics, (std::vector<std::string>{"/wavetank/note=at zero", "/case=kept"}));
  EXPECT_EQ(view.getBeginTime(), ros::TIME_MIN);
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    EXPECT_EQ(connection->header->count("latching") == 1, connection->topic == "/case") << connection->topic;
}

TEST_F(BagWriterTest, LeavesNothingWhenItIsNotFinished) {
  { BagWriter(path("a.bag"), "/wavetank").write("note", ros::Time(1.0), text("lost")); }
  EXPECT_TRUE(fs::is_empty(scratch_.path()));
}

TEST_F(BagWriterTest, KeepsWhatLiesAtItsTemporaryName) {
  scratch_.write("a.bag.active", "of a run that died");
  scratch_.write("a.bag.1.active", "of another");
  {
    BagWriter writer(path("a.bag"), "/wavetank");
    EXPECT_NE(error_of([&] { BagWriter(path("a.bag"), "/wavetank"); }).find("another process is writing it"), std::string::npos);
    writer.write("note", ros::Time(0.5), text("hello"));
    writer.finish();
  }
  EXPECT_EQ(fs::file_size(path("a.bag.2.active")), 18u);
  EXPECT_EQ(fs::file_size(path("a.bag.1.active")), 10u);
  EXPECT_FALSE(fs::exists(path("a.bag.active")));
  EXPECT_EQ(rosbag::View(rosbag::Bag(path("a.bag"))).size(), 1u);
}

/// Several begin at the same moment, and a run that died has left its bag: one of them has the bag, and the others are told so.
TEST_F(BagWriterTest, IsMadeByOneOfThoseThatBeginAtOnce) {
  set_log_sink([](LogLevel, const std::string&) {});
  for (int round = 0; round < 200; ++round) {
    const std::string name = path("a" + std::to_string(round) + ".bag");
    scratch_.write("a" + std::to_string(round) + ".bag.active", "of a run that died");
    constexpr int count = 4;
    std::vector<std::unique_ptr<BagWriter>> writers(count);
    std::vector<std::string> errors(count);
    std::atomic<int> ready = 0;
    std::vector<std::thread> threads;
    for (int k = 0; k < count; ++k)
      threads.emplace_back([&, k] {
        ++ready;
        while (ready < count) std::this_thread::yield();
        try {
          writers[k] = std::make_unique<BagWriter>(name, "/wavetank");
        } catch (const Error& error) {
          errors[k] = error.what();
        }
      });
    for (std::thread& thread : threads) thread.join();
    int made = 0;
    for (int k = 0; k < count; ++k) {
      if (!writers[k]) {
        EXPECT_NE(errors[k].find("another process is writing it"), std::string::npos) << errors[k];
        continue;
      }
      ++made;
      writers[k]->write("note", ros::Time(0.5), text("hello"));
      EXPECT_NO_THROW(writers[k]->finish());
    }
    EXPECT_EQ(made, 1);
    EXPECT_EQ(rosbag::View(rosbag::Bag(name)).size(), 1u);
    EXPECT_EQ(fs::file_size(path("a" + std::to_string(round) + ".bag.1.active")), 18u);
    EXPECT_FALSE(fs::exists(name + ".active") || fs::exists(path("a" + std::to_string(round) + ".bag.2.active"))) << "round " << round;
    if (HasFailure()) break;
  }
  set_log_sink(nullptr);
}

TEST_F(BagWriterTest, KeepsWhatIsWrittenThoughItIsNotFinished) {
  BagWriter writer(path("a.bag"), "/wavetank");
  for (int k = 1; k < 100; ++k) writer.write("note", ros::Time(k), text("hello"));
  writer.keep();
  fs::copy_file(path("a.bag.active"), path("died.bag"));
  writer.write("note", ros::Time(100), text("hello"));
  ASSERT_EQ(std::system(("rosbag reindex --quiet " + path("died.bag") + " > /dev/null").c_str()), 0);
  EXPECT_EQ(rosbag::View(rosbag::Bag(path("died.bag"))).size(), 99u);
  writer.finish();
  EXPECT_EQ(rosbag::View(rosbag::Bag(path("a.bag"))).size(), 100u);
}

TEST_F(BagWriterTest, LeavesAWholeBagUnderItsTemporaryNameWhereAnotherThingTookItsPlace) {
  scratch_.write("precious", "kept");
  BagWriter writer(path("a.bag"), "/wavetank");
  writer.write("note", ros::Time(0.5), text("hello"));
  fs::create_symlink(path("precious"), path("a.bag"));
  EXPECT_NE(error_of([&] { writer.finish(); }).find("a.bag.active"), std::string::npos);
  EXPECT_FALSE(writer.is_open());
  EXPECT_TRUE(fs::is_symlink(path("a.bag")));
  EXPECT_EQ(fs::file_size(path("precious")), 4u);
  EXPECT_EQ(rosbag::View(rosbag::Bag(path("a.bag.active"))).size(), 1u);
}

TEST_F(BagWriterTest, GivesBackWhatItReserved) {
  BagWriter writer(path("a.bag"), "/wavetank");
  writer.write("note", ros::Time(0.5), text("hello"));
  writer.finish();
  struct stat bag;
  ASSERT_EQ(stat(path("a.bag").c_str(), &bag), 0);
  EXPECT_LT(bag.st_blocks * 512, bag.st_size + 65536);
}

TEST_F(BagWriterTest, RefusesPlacesWhereNoBagCanBe) {
  EXPECT_THROW(BagWriter(path("no/such/a.bag"), "/wavetank"), Error);
  EXPECT_THROW(BagWriter(scratch_.path().string(), "/wavetank"), Error);
  EXPECT_THROW(BagWriter("/proc/a.bag", "/wavetank"), Error);
}

}  // namespace wavetank::bag_writer_test
