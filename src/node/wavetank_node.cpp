// The live node: everything is in TankNode; here are only the process's beginning and end.
#include <ros/ros.h>

#include <atomic>
#include <cstdio>
#include <cstring>
#include <memory>

#include "wavetank/common/ending_signals.h"
#include "wavetank/common/log.h"
#include "wavetank/common/standard_output.h"
#include "wavetank/common/version.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/node/parameters.h"
#include "wavetank/node/rank_programs.h"
#include "wavetank/node/tank_node.h"

namespace {

const char* const usage =
    "wavetank_node: a numerical wave tank as a ROS node.\n"
    "Its private parameters are the keys of a case (docs/case.md), or ~case_file names the case and the others replace its keys.\n"
    "Topics, services and the node's own parameters: docs/topics.md. Without a ROS master, use wavetank_run.\n"
    "Exit code: 0 at the end, 2 if the case cannot be read or laid out, 3 if the simulation failed.\n";

std::atomic<bool> is_asked_to_end{false};  // roscpp forgets what it was asked before its first NodeHandle

void log_to_ros(wavetank::LogLevel level, const std::string& line) {
  switch (level) {
    case wavetank::LogLevel::info:
      ROS_INFO("%s", line.c_str());
      break;
    case wavetank::LogLevel::warning:
      ROS_WARN("%s", line.c_str());
      break;
    case wavetank::LogLevel::error:
      ROS_ERROR("%s", line.c_str());
      break;
  }
}

/// `ranks`: null of a process that is alone.
int live(int argc, char** argv, wavetank::parallel::Ranks* ranks) {
  ros::init(argc, argv, "wavetank", ros::init_options::NoSigintHandler);
  for (int i = 1; i < argc; ++i) {
    const bool version = std::strcmp(argv[i], "--version") == 0;
    if (version) std::printf("wavetank %s\n", wavetank::version());
    if (!version) std::fputs(usage, stdout);
    return version || std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0 ? 0 : 2;
  }
  wavetank::set_log_sink(log_to_ros);
  if (!ros::master::check()) ROS_WARN("waiting for a ROS master at %s; without one, use wavetank_run", ros::master::getURI().c_str());
  if (is_asked_to_end) return 0;
  ros::NodeHandle handle, private_handle("~");  // which outlive an error, or its message would not be printed
  try {
    wavetank::TankNode node(handle, private_handle, wavetank::read_setup(private_handle), ranks);
    ros::AsyncSpinner spinner(3);  // one waits for the end of ~advance
    spinner.start();
    // roscpp says that it is not ok only once no call is in progress, and that of ~advance goes on.
    while (ros::ok() && !ros::isShuttingDown() && !is_asked_to_end && !node.wants_to_exit()) ros::WallDuration(0.05).sleep();
    node.stop();  // or the spinner would wait for whoever waits for the end of ~advance
    spinner.stop();
    return node.finish();
  } catch (const wavetank::EndRequested& left) {
    ROS_INFO("%s", wavetank::visible_lines(left.what()).c_str());
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", wavetank::visible_lines(error.what()).c_str());
    return 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  wavetank::let_writing_fail();
  const wavetank::EndingSignals signals([](int) {
    is_asked_to_end = true;
    ros::requestShutdown();
  });
  if (!wavetank::parallel::is_under_launcher()) return live(argc, argv, nullptr);
  std::unique_ptr<wavetank::parallel::Ranks> ranks;
  try {
    ranks = wavetank::parallel::join_ranks();
  } catch (const std::exception& error) {
    if (wavetank::parallel::rank_by_launcher() == 0) std::fprintf(stderr, "wavetank_node: %s\n", error.what());
    return 2;
  }
  if (ranks->rank() > 0) return wavetank::serve_first_rank(*ranks);
  return ranks->end(live(argc, argv, ranks.get()));
}
