#pragma once

#include <string>

#include "key_description.h"
#include "setting.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank::scene {

/// Checks everything about a case but its values: that every key is known, every required one given, alternatives are not mixed, and
/// sections and lists are where they belong. Throws Error.
void check_structure(const Setting& root, const KeyDescription& root_keys);

/// Puts one override into the tree: what it replaces goes, and so do the keys that it excludes (fluid/particles those of fluid/spacing).
/// Throws Error naming the override as it was given ("--set KEY").
void apply_override(Setting& root, const KeyDescription& root_keys, const Override& override);

/// "; did you mean PATH?", or "; the keys of SECTION are ..." when nothing known is near.
std::string suggest_key(const std::string& section_path, const std::string& name, const KeyDescription& section,
                        const KeyDescription& root_keys);

}  // namespace wavetank::scene
