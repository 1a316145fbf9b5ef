#include "wavetank/scene/case_reader.h"

#include <filesystem>

#include "case_keys.h"
#include "named_files.h"
#include "robots.h"
#include "structure.h"
#include "text_file.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

// `directory` is the case file's.
Case read_settings(scene::Setting root, const std::vector<Override>& overrides, const std::string& directory,
                   const Surroundings& surroundings) {
  for (const Override& override : overrides) scene::apply_override(root, scene::case_keys(), override);
  scene::check_structure(root, scene::case_keys());
  scene::Context context{Case{}.dimensions};
  Case read = scene::case_section().read(root, "", context);
  read.directory = directory;
  scene::check_files(read, root);  // before there are bodies that the case's text does not name
  scene::build_robots(read, root, surroundings);
  scene::place_gauges(read, root);
  scene::choose_dissipation(read, root);
  scene::check_case(read, root);
  return read;
}

scene::Setting parse_file(const std::string& path) {
  return scene::parse_settings(scene::read_text_file(path, "case file", "a case is a YAML file"), path);
}

bool is_relative_path(const std::string& uri) { return uri.find("://") == std::string::npos && uri.front() != '/'; }

// The written case has no file that a relative path could refer to.
class AbsolutePaths {
 public:
  explicit AbsolutePaths(const std::string& directory) : directory_(directory) {}

  template <class Whole>
  void make(Whole& whole) const {
    if (auto* mesh = std::get_if<MeshSource>(&whole.shape)) make_path(mesh->uri);
    for (MeshSource& part : whole.rigid.collision_parts) make_path(part.uri);
    for (RecordCase& record : whole.rigid.prescribed.records) make_path(record.file);
    if (whole.rigid.prescribed.waves) make_path(whole.rigid.prescribed.waves->record.file);
  }

  void make(OpeningCase& opening) const {
    if (opening.record) make_path(opening.record->file);
  }

 private:
  void make_path(std::string& uri) const {
    if (!directory_.empty() && !uri.empty() && is_relative_path(uri)) uri = directory_ + "/" + uri;
  }

  const std::string& directory_;
};

}  // namespace

Case read_case_file(const std::string& path, const std::vector<Override>& overrides, const Surroundings& surroundings) {
  scene::Setting root = parse_file(path);
  const std::string directory = std::filesystem::absolute(path).lexically_normal().parent_path().string();
  return read_settings(std::move(root), overrides, directory, surroundings);
}

Case read_case_text(const std::string& yaml, const std::string& source, const std::vector<Override>& overrides,
                    const Surroundings& surroundings) {
  return read_settings(scene::parse_settings(yaml, source), overrides, "", surroundings);
}

std::vector<std::string> robot_parameters_of_file(const std::string& path) { return scene::robot_parameters(parse_file(path)); }

std::vector<std::string> robot_parameters_of_text(const std::string& yaml, const std::string& source) {
  return scene::robot_parameters(scene::parse_settings(yaml, source));
}

std::string write_case(const Case& checked) {
  Case written = checked;
  const AbsolutePaths paths(checked.directory);
  paths.make(written.tank);
  for (BodyCase& body : written.bodies) paths.make(body);
  for (OpeningCase& opening : written.openings) paths.make(opening);
  return scene::write_settings(scene::case_section().write(written, scene::Context{written.dimensions}));
}

}  // namespace wavetank
