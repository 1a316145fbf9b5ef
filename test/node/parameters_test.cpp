#include "wavetank/node/parameters.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "wavetank/common/error.h"
#include "wavetank/node/resources.h"

namespace wavetank::parameters_test {

using XmlRpc::XmlRpcValue;

TEST(YamlOf, KeepsNumbersAndTruth) {
  EXPECT_EQ(yaml_of(XmlRpcValue(3)), "3");
  EXPECT_EQ(yaml_of(XmlRpcValue(3.0)), "3.0");
  EXPECT_EQ(yaml_of(XmlRpcValue(0.1)), "0.1");
  EXPECT_EQ(yaml_of(XmlRpcValue(true)), "true");
  for (const double value : {8.94e-4, 1.0 / 3.0, 1e300, -2.5e-17}) EXPECT_EQ(YAML::Load(yaml_of(XmlRpcValue(value))).as<double>(), value);
}

TEST(YamlOf, KeepsTextAsText) {
  EXPECT_EQ(yaml_of(XmlRpcValue("0:1")), "\"0:1\"");
  EXPECT_EQ(yaml_of(XmlRpcValue("true")), "\"true\"");
  EXPECT_EQ(yaml_of(XmlRpcValue("12")), "\"12\"");
  EXPECT_EQ(YAML::Load(yaml_of(XmlRpcValue("a \"b\"\n# c: d"))).as<std::string>(), "a \"b\"\n# c: d");
}

TEST(YamlOf, TakesExponentialNumbersThatRosparamReadAsText) {
  EXPECT_EQ(yaml_of(XmlRpcValue("1e-3")), "1e-3");
  EXPECT_EQ(yaml_of(XmlRpcValue("-2.5E6")), "-2.5E6");
  EXPECT_EQ(yaml_of(XmlRpcValue("e5")), "\"e5\"");
}

TEST(YamlOf, KeepsListsAndGroups) {
  XmlRpcValue tree;
  tree["title"] = "a: b";
  tree["fluid"]["spacing"] = 0.02;
  tree["gravity"][0] = 0;
  tree["gravity"][1] = 0.0;
  tree["gravity"][2] = -9.81;
  tree["bodies"].setSize(0);
  const YAML::Node read = YAML::Load(yaml_of(tree));
  EXPECT_EQ(read["title"].as<std::string>(), "a: b");
  EXPECT_EQ(read["fluid"]["spacing"].as<double>(), 0.02);
  ASSERT_EQ(read["gravity"].size(), 3U);
  EXPECT_EQ(read["gravity"][2].as<double>(), -9.81);
  EXPECT_TRUE(read["bodies"].IsSequence());
}

TEST(ResolveResource, SaysWhatIsWrongWithAnAddress) {
  EXPECT_THROW(resolve_resource("http://example.org/a.stl"), Error);
  EXPECT_THROW(resolve_resource("package://"), Error);
  EXPECT_THROW(resolve_resource("package://wavetank"), Error);
  try {
    resolve_resource("package://no_such_package_at_all/a.stl");
    FAIL() << "an unknown package was found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no_such_package_at_all"), std::string::npos);
  }
}

}  // namespace wavetank::parameters_test
