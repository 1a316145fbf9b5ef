// Kernels' parameters are found by name, and what does not fit is told when a kernel is bound.
#include "wavetank/compute/arguments.h"

#include "compute_fixture.h"

namespace wavetank::compute::arguments_test {
namespace {

const char* const source =
    "typedef float real;\n"
    "#define MORE \\\n"
    "  __global const int *offset, int factor  // of both\n"
    "/* a kernel void other(int nothing) in a comment is after the first */\n"
    "__kernel void scaled(int count, __global const real* from, MORE,\n"
    "                     __global real* to) {\n"
    "  const int i = get_global_id(0);\n"
    "  if (i < count) to[i] = factor * from[i] + offset[0];\n"
    "}\n";

class ArgumentsTest : public ::testing::Test {
 protected:
  ArgumentsTest() : kernel(Program(device, {{"s.cl", source}}, "s.cl", "", Build::at_first_use).kernel("scaled")) {
    arguments.memory("from", std::as_const(from)).memory("to", to).memory("offset", offset).value("count", count).value("factor", factor);
  }

  void expect_refused(const std::string& words) {
    try {
      BoundKernel bound(kernel, arguments);
      FAIL() << "bound, though: " << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  Device device{choose_device("auto")};
  Kernel kernel;
  int count = 3, factor = 2;
  Buffer<float> from{device, std::vector<float>{1, 2, 3, 4}}, to{device, 4};
  Buffer<int> offset{device, std::vector<int>{10}};
  Arguments arguments{std::map<std::string, std::string>{{"real", "float"}}};
};

TEST_F(ArgumentsTest, AreWhatTheyAreWhenTheKernelIsLaunched) {
  const BoundKernel bound(kernel, arguments);
  bound.launch(4);
  EXPECT_EQ(to.download(), (std::vector<float>{12, 14, 16, 0}));
  std::swap(from, to);
  factor = 1;
  count = 4;
  bound.launch(4);
  EXPECT_EQ(to.download(), (std::vector<float>{22, 24, 26, 10}));
  offset = Buffer<int>(device, std::vector<int>{-10});
  bound.launch(4);
  EXPECT_EQ(to.download(), (std::vector<float>{2, 4, 6, -10}));
}

TEST_F(ArgumentsTest, AreRefusedWhereTheyDoNotFit) {
  arguments = Arguments(std::map<std::string, std::string>{{"real", "float"}});
  expect_refused("asks for \"count\", but nothing is called so");
  arguments.memory("from", from).memory("to", to).memory("offset", offset).value("count", count);
  expect_refused("asks for \"factor\", but nothing is called so");
  const float fraction = 0.5f;
  arguments.value("factor", fraction);
  expect_refused("asks for \"factor\" as int, but it is float");
  arguments.memory("factor", offset);
  expect_refused("asks for \"factor\" as a single value, but it is an array");
  arguments.value("factor", factor).value("offset", factor);
  expect_refused("asks for \"offset\" as an array, but it is a single value");
  arguments.memory("offset", offset).memory("from", offset);
  expect_refused("asks for \"from\" as float, but it is int");
  arguments.memory("from", from).memory("to", std::as_const(to));
  expect_refused("the kernel scaled asks for \"to\" to write to it, but there it may only be read");
}

TEST_F(ArgumentsTest, ABuildAtFirstUseTellsThenWhatIsWrong) {
  const SourceFiles files{{"s.cl", "kernel void broken(global int* o) { o[0] = nothing; }\n"}};
  const Kernel broken = Program(device, files, "s.cl", "", Build::at_first_use).kernel("broken");
  const BoundKernel bound(broken, Arguments().memory("o", offset));
  EXPECT_THROW(bound.launch(1), Error);
  const Kernel missing = Program(device, {{"s.cl", source}}, "s.cl", "", Build::at_first_use).kernel("missing");
  EXPECT_THROW(BoundKernel(missing, arguments), Error);
}

}  // namespace
}  // namespace wavetank::compute::arguments_test
