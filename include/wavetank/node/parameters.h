#pragma once

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

#include <string>

#include "wavetank/scene/case.h"

namespace wavetank {

/// Private parameters of wavetank_node that are not keys of the case.
struct NodeParameters {
  std::string case_file;                 ///< case to read; the other parameters then replace its keys. Empty = the parameters are the case
  std::string restore;                   ///< snapshot to go on from
  std::string snapshot_directory;        ///< where ~save writes; default: the working directory ($ROS_HOME under roslaunch)
  std::string bag;                       ///< bag for the node to write itself, every sample in it; empty = none
  bool bag_clouds = false;               ///< with the free surface in it
  bool bag_surface = false;              ///< with the water's surface as a mesh and a height map in it
  bool paused = false;                   ///< the run begins paused
  bool exit_at_end = false;              ///< end the process when the duration has passed
  double wait_for_subscribers = 0.0;     ///< s of wall time that the first step may wait for a subscriber of every list of samples
  double external_wrench_timeout = 0.5;  ///< s of simulated time that a wrench from a topic is held; 0 = until it is replaced
};

/// Private parameter in which a node that publishes /clock notes how far that is, s, for whoever follows it under its name.
inline const std::string clock_reached = "clock_reached";

/// What a live node is made from.
struct NodeSetup {
  Case scene;
  NodeParameters parameters;
};

/// Reads a node's private namespace: its own parameters, and the case from all others. Throws Error as read_case_text, with the namespace
/// in the place of the file's name.
NodeSetup read_setup(const ros::NodeHandle& private_handle);

/// A parameter's value as YAML of the same types: text stays text, whatever it looks like, except numbers as 1e-3, which rosparam reads as
/// text.
std::string yaml_of(const XmlRpc::XmlRpcValue& value);

}  // namespace wavetank
