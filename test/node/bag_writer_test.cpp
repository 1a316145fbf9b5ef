#include "wavetank/node/bag_writer.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <sys/stat.h>

#include <filesystem>

#include "../common/error_of.h"
#include "../common/scratch_directory.h"

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
