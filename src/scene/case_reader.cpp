#include "wavetank/scene/case_reader.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "case_keys.h"
#include "structure.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t greatest_file = 16u << 20;  // bytes; a case is a few kB, and /dev/zero has no end

std::string read_whole_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(path + ": is a directory; a case is a YAML file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot open the case file: " + std::strerror(errno != 0 ? errno : ENOENT));
  std::string text;
  for (char block[65536]; file.read(block, sizeof block) || file.gcount() > 0;) {
    text.append(block, static_cast<std::size_t>(file.gcount()));
    if (text.size() > greatest_file) throw Error(path + ": is larger than 16 MiB; that is no case file");
  }
  if (file.bad()) throw Error(path + ": reading the case file failed: " + std::strerror(errno));
  return text;
}

Case read_settings(scene::Setting root, const std::vector<Override>& overrides) {
  for (const Override& override : overrides) scene::apply_override(root, scene::case_keys(), override);
  scene::check_structure(root, scene::case_keys());
  scene::Context context{Case{}.dimensions};
  Case read = scene::case_section().read(root, "", context);
  scene::check_case(read, root);
  return read;
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
  }

 private:
  void make_path(std::string& uri) const {
    if (!directory_.empty() && !uri.empty() && is_relative_path(uri)) uri = directory_ + "/" + uri;
  }

  const std::string& directory_;
};

}  // namespace

Case read_case_file(const std::string& path, const std::vector<Override>& overrides) {
  Case read = read_case_text(read_whole_file(path), path, overrides);
  read.directory = std::filesystem::absolute(path).lexically_normal().parent_path().string();
  return read;
}

Case read_case_text(const std::string& yaml, const std::string& source, const std::vector<Override>& overrides) {
  return read_settings(scene::parse_settings(yaml, source), overrides);
}

std::string write_case(const Case& checked) {
  Case written = checked;
  const AbsolutePaths paths(checked.directory);
  paths.make(written.tank);
  for (BodyCase& body : written.bodies) paths.make(body);
  return scene::write_settings(scene::case_section().write(written, scene::Context{written.dimensions}));
}

}  // namespace wavetank
