#pragma once

#include <string>

#include "wavetank/scene/case.h"

/// Names of topics and tf frames, the same in a live node and in a bag. Topics are relative to the node's private namespace.
namespace wavetank {

/// A name of the case as one level of a topic or frame: what ROS does not allow there becomes an underscore.
std::string graph_name(const std::string& name);

std::string probe_topic(const std::string& probe);                                    ///< "probes/P1"
std::string gauge_topic(const std::string& gauge);                                    ///< "gauges/H1"
std::string velocity_topic(const std::string& probe);                                 ///< "velocities/V1"
std::string section_topic(const std::string& section);                                ///< "sections/weir"
std::string imu_topic(const std::string& body);                                       ///< "bodies/box/imu"
std::string mooring_topic(const std::string& body, const std::string& mooring);       ///< "bodies/box/moorings/bow/tension"
std::string joint_command_topic(const std::string& joint);                            ///< "joints/flap/command", listened to
std::string wrench_topic(const std::string& body);                                    ///< "bodies/box/wrench"
std::string odometry_topic(const std::string& body);                                  ///< "bodies/box/odom"
std::string inertia_topic(const std::string& body);                                   ///< "bodies/box/inertia"
std::string outside_wrench_topic(const std::string& body);                            ///< "bodies/box/external_wrench", listened to
std::string command_topic(const std::string& body);                                   ///< "bodies/box/cmd_vel", listened to
std::string flow_topic(const std::string& opening);                                   ///< "openings/hose/flow"
std::string discharge_topic(const std::string& opening);                              ///< "openings/hose/discharge", listened to
std::string probe_frame(const PublishingCase& publishing, const std::string& probe);  ///< "tank/probes/P1"
std::string body_frame(const PublishingCase& publishing, const std::string& body);    ///< "tank/bodies/box"
std::string imu_frame(const PublishingCase& publishing, const std::string& body);     ///< "tank/bodies/box/imu"
/// The frame that a moving tank moves in: "world", or "inertial" if the tank's own frame is called "world".
std::string inertial_frame(const PublishingCase& publishing);

/// Of a mooring, as it is given, or its place in the list.
std::string name_of(const RigidCase& rigid, std::size_t mooring);

/// The tank's own name among the bodies.
inline const std::string tank_name = "tank";

/// Throws Error if two instruments of a kind, two openings, two joints, or two bodies (the tank is one), would have the same topic.
void check_names(const Case& checked);

}  // namespace wavetank
