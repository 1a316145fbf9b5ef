#pragma once

#include <string>

namespace wavetank::scene {

/// The text of a file of at most 16 MiB. `kind` names it in messages ("case file"), `nature` says what it should be ("a case is a YAML
/// file"). Throws Error.
std::string read_text_file(const std::string& path, const std::string& kind, const std::string& nature);

}  // namespace wavetank::scene
