#include "wavetank/compute/program.h"

#include <numeric>

#include "compute_fixture.h"

namespace wavetank::compute::program_test {
namespace {

class ProgramTest : public ::testing::Test {
 protected:
  Device device{choose_device("auto"), true};

  /// The single int that kernel `answer(global int*)` of the program writes.
  int answer(const Program& program) {
    Buffer<int> out(device, 1);
    program.kernel("answer").launch(1, out);
    return out.download()[0];
  }
};

TEST_F(ProgramTest, RunsSaxpyForEveryCount) {
  const Kernel saxpy = Program(device, {{"saxpy.cl", saxpy_source()}}, "saxpy.cl", "").kernel("saxpy");  // which outlives its Program
  for (const int count : {1, 63, 64, 65, 1000, 70001}) {
    std::vector<float> x(count), expected(count);
    std::iota(x.begin(), x.end(), 0.0f);
    for (int i = 0; i < count; ++i) expected[i] = 1.0f + 0.5f * x[i];
    const Buffer<float> xs(device, x);
    const Buffer<float> ys(device, std::vector<float>(count, 1.0f));
    saxpy.launch(count, ys, xs, 0.5f, count);
    EXPECT_EQ(ys.download(), expected) << count;
  }
}

TEST_F(ProgramTest, RunsNothingForNoItems) {
  const Kernel kernel = Program(device, {{"a.cl", "kernel void answer(global int* o) { o[0] = 1; }"}}, "a.cl", "").kernel("answer");
  const Buffer<int> out(device, 1);
  kernel.launch(0, out);
  kernel.launch_groups(0, 1, out);
  EXPECT_EQ(out.download()[0], 0);
  EXPECT_TRUE(device.timings().empty());
}

TEST_F(ProgramTest, RunsWorkGroupsOfAGivenSize) {
  const char* source =
      "kernel void total(global const int* in, global int* out) {\n"
      "  local int partial[16];\n"
      "  int i = get_local_id(0);\n"
      "  partial[i] = in[get_global_id(0)];\n"
      "  for (int half_size = 8; half_size > 0; half_size /= 2) {\n"
      "    barrier(CLK_LOCAL_MEM_FENCE);\n"
      "    if (i < half_size) partial[i] += partial[i + half_size];\n"
      "  }\n"
      "  if (i == 0) out[get_group_id(0)] = partial[0];\n"
      "}\n";
  const Kernel kernel = Program(device, {{"t.cl", source}}, "t.cl", "").kernel("total");
  std::vector<int> values(48);
  std::iota(values.begin(), values.end(), 0);
  const Buffer<int> in(device, values), out(device, 3);
  kernel.launch_groups(3, 16, in, out);
  EXPECT_EQ(out.download(), (std::vector<int>{120, 376, 632}));
  const std::string error = error_of([&] { kernel.launch_groups(1, 1u << 30, in, out); });
  EXPECT_TRUE(contains(error, "total")) << error;
  EXPECT_TRUE(contains(error, "work-groups")) << error;
}

TEST_F(ProgramTest, RefusesWrongArguments) {
  const Kernel saxpy = Program(device, {{"saxpy.cl", saxpy_source()}}, "saxpy.cl", "").kernel("saxpy");
  const Buffer<float> x(device, 4), y(device, 4), nothing;
  const std::string too_few = error_of([&] { saxpy.launch(4, y, x, 1.0f); });
  EXPECT_TRUE(contains(too_few, "saxpy takes 4 arguments, but 3 were given")) << too_few;
  const std::string too_many = error_of([&] { saxpy.launch(4, y, x, 1.0f, 4, 5); });
  EXPECT_TRUE(contains(too_many, "but 5 were given")) << too_many;
  const std::string missing = error_of([&] { saxpy.launch(4, y, nothing, 1.0f, 4); });
  EXPECT_TRUE(contains(missing, "argument 2 of the kernel saxpy")) << missing;
  const std::string wide = error_of([&] { saxpy.launch(4, y, x, 1.0, 4); });
  EXPECT_TRUE(contains(wide, "argument 3 of the kernel saxpy")) << wide;
  error_of([&] { Kernel().launch(1); });
}

TEST_F(ProgramTest, NamesTheKernelsThatThereAre) {
  const Program program(device, {{"saxpy.cl", saxpy_source()}}, "saxpy.cl", "");
  const std::string error = error_of([&] { program.kernel("daxpy"); });
  EXPECT_TRUE(contains(error, "saxpy.cl has no kernel \"daxpy\"; it has: saxpy")) << error;
  error_of([] { Program().kernel("saxpy"); });
}

TEST_F(ProgramTest, LeavesConditionalIncludesToThePreprocessor) {
  const SourceFiles files{{"main.cl",
                           "#if SCHEME == 1\n#include \"value.cl\"\n#else\n#include \"value.cl\"\n#include \"value.cl\"\n#endif\n"
                           "kernel void answer(global int* o) { o[0] = value() + SCHEME; }\n"},
                          {"value.cl", "int value(void) { return 40; }\n"}};
  EXPECT_EQ(answer(Program(device, files, "main.cl", "-DSCHEME=1")), 41);
  EXPECT_EQ(answer(Program(device, files, "main.cl", "-DSCHEME=2")), 42);
}

TEST_F(ProgramTest, NamesFileAndLineOfABuildErrorAndQuotesIt) {
  const SourceFiles files{{"main.cl", "#include \"law.cl\"\nkernel void k(global float* o) { o[0] = law(1.0f); }\n"},
                          {"law.cl", "// a law\nfloat law(float x) {\n  return x * stiffnes;\n}\n"}};
  const std::string error = error_of([&] { Program(device, files, "main.cl", "-DX=1"); });
  EXPECT_TRUE(contains(error, "law.cl:3: ")) << error;
  EXPECT_TRUE(contains(error, "    return x * stiffnes;")) << error;
  EXPECT_TRUE(contains(error, device.info().name)) << error;
  const SourceFiles later{{"main.cl", "#include \"law.cl\"\n\nkernel void k(global float* o) { o[0] = lw(1.0f) + nothing; }\n"},
                          {"law.cl", "float law(float x) { return x; }\n"}};
  const std::string second = error_of([&] { Program(device, later, "main.cl", ""); });
  EXPECT_TRUE(contains(second, "main.cl:3: ")) << second;
  EXPECT_TRUE(contains(second, "kernel void k(")) << second;
}

TEST_F(ProgramTest, CountsLaunchesByKernel) {
  const SourceFiles files{{"a.cl",
                           "kernel void idle(global int* o) { if (get_global_id(0) == 0) o[0] += 1; }\n"
                           "kernel void busy(global int* o) { int s = o[1]; for (int i = 0; i < 20000; ++i) s = s * 5 + i; o[1] = s; }\n"}};
  const Program program(device, files, "a.cl", "");
  const Kernel idle = program.kernel("idle"), busy = program.kernel("busy");
  const Buffer<int> out(device, 2);
  for (int i = 0; i < 1234; ++i) idle.launch(1, out);  // more than are kept pending at once
  for (int i = 0; i < 3; ++i) busy.launch(1, out);
  EXPECT_EQ(out.download()[0], 1234);
  const auto timings = device.timings();
  ASSERT_EQ(timings.size(), 2u);
  EXPECT_GE(timings[0].seconds, timings[1].seconds);
  for (const KernelTiming& timing : timings) {
    EXPECT_EQ(timing.launches, timing.kernel == "idle" ? 1234u : 3u);
    EXPECT_GE(timing.seconds, 0.0);
    EXPECT_LT(timing.seconds, 60.0);
  }
  device.reset_timings();
  EXPECT_TRUE(device.timings().empty());
}

TEST_F(ProgramTest, TimesNothingUnlessAsked) {
  const Device plain(choose_device("auto"));
  const Buffer<int> out(plain, 1);
  Program(plain, {{"a.cl", "kernel void k(global int* o) { o[0] = 1; }"}}, "a.cl", "").kernel("k").launch(1, out);
  EXPECT_EQ(out.download()[0], 1);
  EXPECT_TRUE(plain.timings().empty());
}

}  // namespace
}  // namespace wavetank::compute::program_test
