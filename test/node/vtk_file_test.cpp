#include "wavetank/node/vtk_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <ctime>
#include <numeric>
#include <random>

#include "wavetank/common/error.h"

namespace wavetank::vtk_file_test {
namespace {

VtkPolygons two_triangles() {
  VtkPolygons polygons;
  polygons.cells = VtkPolygons::Cells::triangles;
  polygons.points = std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
  polygons.fields = {{"pressure", 1, std::vector<float>{1, 2, 3, 4, 5, 6}, true}, {"name", 1, std::vector<std::string>(6, "P"), false}};
  return polygons;
}

/// The values of an array, by the format's own description: where its line says, behind four numbers of 8 bytes, packed by zlib.
template <class Value>
std::vector<Value> values_of(const std::string& content, const std::string& name) {
  const std::string mark = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t raw = content.find(mark) + mark.size(), line = content.find("Name=\"" + name + "\"");
  const std::size_t offset = std::stoul(content.substr(content.find("offset=\"", line) + 8));
  std::uint64_t head[4];
  std::memcpy(head, &content[raw + offset], sizeof head);
  EXPECT_EQ(head[0], 1U);
  EXPECT_EQ(head[2], 0U);
  std::vector<Value> values(head[1] / sizeof(Value));
  uLongf length = head[1];
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(values.data()), &length,
                       reinterpret_cast<const Bytef*>(&content[raw + offset + sizeof head]), head[3]),
            Z_OK);
  EXPECT_EQ(length, head[1]);
  return values;
}

}  // namespace

TEST(VtkFile, HasPointsCellsAndFieldsWhereItsLinesSay) {
  const VtkPolygons polygons = two_triangles();
  const std::string content = vtp_content(polygons);
  EXPECT_NE(content.find("NumberOfPoints=\"6\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"2\""),
            std::string::npos);
  EXPECT_EQ(values_of<double>(content, "points"), std::get<std::vector<double>>(polygons.points));
  EXPECT_EQ(values_of<float>(content, "pressure"), std::get<std::vector<float>>(polygons.fields[0].values));
  EXPECT_EQ(values_of<std::int32_t>(content, "offsets"), (std::vector<std::int32_t>{3, 6}));
  EXPECT_EQ(values_of<std::int32_t>(content, "connectivity"), (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
  const std::vector<char> names = values_of<char>(content, "name");
  EXPECT_EQ(std::string(names.data(), 4), std::string("P\0P\0", 4));
}

TEST(VtkFile, IsWellFormedWithoutPoints) {
  VtkPolygons nothing;
  nothing.points = std::vector<float>();
  const std::string content = vtp_content(nothing);
  EXPECT_NE(content.find("NumberOfPoints=\"0\" NumberOfVerts=\"0\""), std::string::npos);
  EXPECT_EQ(content.substr(content.size() - 11), "</VTKFile>\n");
}

TEST(VtkFile, RefusesFieldsOfAnotherLength) {
  VtkPolygons polygons = two_triangles();
  polygons.fields.push_back({"velocity", 3, std::vector<float>(6), false});
  EXPECT_THROW(vtp_content(polygons), Error);
}

TEST(VtkFile, OfManyParticlesIsSmallAndQuick) {
  // bars: 5 MB and 0.2 s a frame of 110 thousand; of time twice that, on a machine that is busy
  constexpr std::size_t count = 110000;
  std::mt19937 random(20);
  const auto noise = [&](std::size_t length) {
    std::uniform_real_distribution<float> uniform;
    std::vector<float> values(length);
    for (float& value : values) value = uniform(random);
    return values;
  };
  VtkPolygons water;
  water.points = noise(3 * count);
  std::vector<std::uint32_t> ids(count);
  std::iota(ids.begin(), ids.end(), 0U);
  water.fields = {{"velocity", 3, noise(3 * count), false},
                  {"pressure", 1, noise(count), false},
                  {"density", 1, noise(count), false},
                  {"mass", 1, std::vector<float>(count, 6.1F), true},
                  {"id", 1, ids, true},
                  {"gamma", 1, std::vector<float>(count, 1.0F), true},
                  {"surface", 1, std::vector<std::uint8_t>(count, 0), true}};
  const std::clock_t begin = std::clock();
  const std::string content = vtp_content(water);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 0.4);
  EXPECT_LT(content.size(), 5000000U);
  RecordProperty("milliseconds", static_cast<int>(1000 * (std::clock() - begin) / CLOCKS_PER_SEC));
}

TEST(VtkFile, CollectionsListTimesAndNames) {
  VtkCollection collection;
  collection.add(0.05, 2, "a<b", "data/water_00001.vtp");
  EXPECT_NE(collection.content().find("<DataSet timestep=\"0.05\" part=\"2\" name=\"a&lt;b\" file=\"data/water_00001.vtp\"/>"),
            std::string::npos);
}

}  // namespace wavetank::vtk_file_test
