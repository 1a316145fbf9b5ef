#include "wavetank/node/clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

namespace wavetank::clouds_test {

namespace {

ParticleCloud row(std::size_t count) {
  ParticleCloud cloud;
  cloud.time = 0.75;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    cloud.id.push_back(static_cast<std::uint32_t>(i));
    cloud.position.emplace_back(x, 0.5F, 1.5F);
    cloud.velocity.emplace_back(-x, 2.0F, 3.0F);
    cloud.pressure.push_back(100.0F * x);
    cloud.density.push_back(998.0F + x);
    cloud.mass.push_back(0.001F);
    cloud.shepard.push_back(0.5F);
    cloud.eigenvalue.push_back(0.7F);
    cloud.surface.push_back(i % 20 == 19 ? 1 : 0);
  }
  return cloud;
}

float field(const sensor_msgs::PointCloud2& cloud, std::size_t point, const std::string& name) {
  for (const sensor_msgs::PointField& entry : cloud.fields) {
    if (entry.name != name) continue;
    float value = 0;
    std::memcpy(&value, &cloud.data[point * cloud.point_step + entry.offset], sizeof value);
    return value;
  }
  ADD_FAILURE() << "no field " << name;
  return NAN;
}

}  // namespace

TEST(CloudMessage, OfTheSurfaceHasSevenFloatsAPoint) {
  const auto message = cloud_message(row(4), CloudFields::surface, 100, "basin", StampClock());
  EXPECT_EQ(message.header.stamp, ros::Time(0.75));
  EXPECT_EQ(message.header.frame_id, "basin");
  EXPECT_EQ(message.point_step, 28U);
  EXPECT_EQ(message.width, 4U);
  EXPECT_EQ(message.height, 1U);
  EXPECT_EQ(message.row_step, 112U);
  EXPECT_EQ(message.data.size(), 112U);
  std::vector<std::string> names;
  for (const auto& entry : message.fields) {
    names.push_back(entry.name);
    EXPECT_EQ(entry.datatype, sensor_msgs::PointField::FLOAT32);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "vx", "vy", "vz", "pressure"}));
  EXPECT_EQ(field(message, 3, "x"), 3.0F);
  EXPECT_EQ(field(message, 3, "z"), 1.5F);
  EXPECT_EQ(field(message, 3, "vx"), -3.0F);
  EXPECT_EQ(field(message, 3, "vz"), 3.0F);
  EXPECT_EQ(field(message, 3, "pressure"), 300.0F);
}

TEST(CloudMessage, OfAllAddsDensityShepardAndSurface) {
  const auto message = cloud_message(row(20), CloudFields::all, 100, "basin", StampClock());
  EXPECT_EQ(message.point_step, 44U);
  EXPECT_EQ(field(message, 19, "density"), 1017.0F);
  EXPECT_EQ(field(message, 19, "shepard"), 0.5F);
  EXPECT_EQ(field(message, 19, "eigenvalue"), 0.7F);
  EXPECT_EQ(field(message, 19, "surface"), 1.0F);
  EXPECT_EQ(field(message, 18, "surface"), 0.0F);
}

TEST(CloudMessage, IsThinnedEvenlyToMaxPoints) {
  const auto message = cloud_message(row(10000), CloudFields::surface, 1000, "basin", StampClock());
  EXPECT_LE(message.width, 1000U);
  EXPECT_GE(message.width, 950U);
  float before = 0;
  for (std::size_t i = 0; i < message.width; ++i) {
    EXPECT_LT(field(message, i, "x") - before, 40.0F) << "a gap of four times the mean";
    before = field(message, i, "x");
  }
}

TEST(CloudMessage, ThinsASubsetWhoseIdsAreARowOfTheLattice) {
  const ParticleCloud surface = surface_of(row(10000));
  ASSERT_EQ(surface.id.size(), 500U);
  const auto message = cloud_message(surface, CloudFields::surface, 100, "basin", StampClock());
  EXPECT_LE(message.width, 100U);
  EXPECT_GE(message.width, 80U);
}

TEST(CloudMessage, KeepsTheSameParticlesWhateverTheirOrder) {
  ParticleCloud cloud = row(1000);
  ParticleCloud turned = cloud;
  std::reverse(turned.id.begin(), turned.id.end());
  std::reverse(turned.position.begin(), turned.position.end());
  std::set<float> first, second;
  const auto a = cloud_message(cloud, CloudFields::surface, 100, "basin", StampClock());
  const auto b = cloud_message(turned, CloudFields::surface, 100, "basin", StampClock());
  for (std::size_t i = 0; i < a.width; ++i) first.insert(field(a, i, "x"));
  for (std::size_t i = 0; i < b.width; ++i) second.insert(field(b, i, "x"));
  EXPECT_EQ(first, second);
}

TEST(CloudMessage, OfNothingIsEmpty) {
  const auto message = cloud_message(ParticleCloud(), CloudFields::all, 100, "basin", StampClock());
  EXPECT_EQ(message.width, 0U);
  EXPECT_TRUE(message.data.empty());
}

}  // namespace wavetank::clouds_test
