#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wavetank/scene/case.h"
#include "wavetank/scene/file_path.h"

namespace wavetank {

/// One `--set a/b/c=value`: replaces or adds a key before the case is checked. Lists are indexed by number (fluid/fill/0/box/max).
struct Override {
  std::string key;
  std::string value;                ///< YAML
  std::string given_as = "--set ";  ///< what a message has before the key
};

/// What a case can name and only the program that reads it can find; a case that needs what is empty here is refused.
struct Surroundings {
  ResourceResolver resolve;                                       ///< of package:// URIs
  std::function<std::string(const std::string& name)> parameter;  ///< the text that a ROS parameter holds; throws Error
};

/// Reads and checks a whole case from a YAML file, and makes bodies and joints of its robots. Throws Error naming the file, line, key's
/// path, what was given, what is allowed, and for an unknown key the nearest known one.
Case read_case_file(const std::string& path, const std::vector<Override>& overrides = {}, const Surroundings& surroundings = {});

/// The same from YAML text; `source` stands for the file's name in messages (the parameter server's namespace, say).
Case read_case_text(const std::string& yaml, const std::string& source, const std::vector<Override>& overrides = {},
                    const Surroundings& surroundings = {});

/// Names of the ROS parameters that hold the descriptions of a case's robots (robots/N/parameter), for a program that finds them among the
/// keys of the case. Throws Error where the case cannot be read at all; what else is wrong with it is for the readers above.
std::vector<std::string> robot_parameters_of_file(const std::string& path);
std::vector<std::string> robot_parameters_of_text(const std::string& yaml, const std::string& source);

/// The complete case, every default filled in, as YAML that read_case_text accepts and reads back to the same case.
std::string write_case(const Case& checked);

/// Every key with its type, unit, range, default and description, as the Markdown page docs/case.md.
std::string describe_case_keys();

}  // namespace wavetank
