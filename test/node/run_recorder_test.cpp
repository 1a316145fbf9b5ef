// A run in a bag, and what becomes of it where the disk has no room for its last surface.
#include "wavetank/node/run_recorder.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <sys/resource.h>

#include "../common/box_case.h"
#include "../common/scratch_directory.h"
#include "wavetank/common/standard_output.h"

namespace wavetank::run_recorder_test {
namespace {

/// No file of this process may grow beyond that many bytes.
class FileLimit {
 public:
  explicit FileLimit(rlim_t most) {
    let_writing_fail();  // as the programs do: a signal would end this one
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = most;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(RunRecorder, TellsOfALastSurfaceThatHasNoRoom) {
  if (!can_find_surface()) GTEST_SKIP() << why_no_surface;
  Case scene = box_case(Vector3d(0.6, 0.5, 0.4), 0.3, 0.02);  // 7000 triangles of 72 bytes
  scene.numerics.packing.iterations = 0;
  const Simulation simulation(scene);
  const ScratchDirectory scratch;
  const std::string bag = scratch.file("a.bag");
  const StampClock clock;
  {  // the kernels are compiled, into files of the compiler, before there is no room
    RunRecorder recorder(scratch.file("before.bag"), "/wavetank", scene, clock, {false, false, true});
    RunState run;
    run.phase = SolverStatus::RUNNING;
    recorder.start(simulation, body_frames(scene, {Vector3d::Zero()}));
    recorder.record(simulation, {}, run);
    recorder.finish(simulation.state(), simulation.energies(), run);
  }
  std::string told;
  {
    const FileLimit limit(800000);  // of which the end of the bag takes some 600 000
    RunRecorder recorder(bag, "/wavetank", scene, clock, {false, false, true});
    recorder.start(simulation, body_frames(scene, {Vector3d::Zero()}));
    RunState run;
    run.phase = SolverStatus::RUNNING;
    try {
      recorder.record(simulation, {}, run);  // where the surface is found at once
    } catch (const BagError& error) {
      told = error.what();
    }
    run.phase = told.empty() ? SolverStatus::FINISHED : SolverStatus::FAILED;
    run.failure = told;
    try {
      recorder.finish(simulation.state(), simulation.energies(), run);
    } catch (const BagError& error) {
      told = error.what();
    }
    EXPECT_TRUE(recorder.is_whole());
  }
  EXPECT_NE(told.find("limit on the size of files"), std::string::npos) << told;
  rosbag::Bag opened(bag);
  rosbag::View view(opened, rosbag::TopicQuery("/wavetank/status"));
  ASSERT_EQ(view.size(), 1u);
  const auto status = view.begin()->instantiate<SolverStatus>();
  EXPECT_EQ(status->phase, SolverStatus::FAILED);
  EXPECT_EQ(status->failure, told);
}

}  // namespace
}  // namespace wavetank::run_recorder_test
