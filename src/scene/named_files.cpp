#include "named_files.h"

#include "wavetank/common/error.h"
#include "wavetank/scene/file_path.h"

namespace wavetank::scene {
namespace {

class FileCheck {
 public:
  FileCheck(const std::string& directory, const Setting& root) : directory_(directory), root_(root) {}

  template <class Whole>
  void check(const Whole& whole, const std::string& path) const {
    if (const auto* mesh = std::get_if<MeshSource>(&whole.shape)) check_named("mesh", mesh->uri, join_path(path, "mesh"));
    const std::vector<MeshSource>& parts = whole.rigid.collision_parts;
    for (std::size_t i = 0; i < parts.size(); ++i)
      check_named("mesh", parts[i].uri, join_path(join_path(join_path(path, "collision_parts"), i), "mesh"));
    const std::vector<RecordCase>& records = whole.rigid.prescribed.records;
    for (std::size_t i = 0; i < records.size(); ++i)
      check_named("motion record", records[i].file, join_path(join_path(join_path(path, "prescribed/records"), i), "file"));
    const std::optional<WaveCase>& waves = whole.rigid.prescribed.waves;
    if (waves && waves->kind == WaveKind::record)
      check_named("wave record", waves->record.file, join_path(path, "prescribed/waves/record/file"));
  }

  void check(const OpeningCase& opening, const std::string& path) const {
    if (opening.record) check_named("flow record", opening.record->file, join_path(path, "record/file"));
  }

 private:
  bool can_find(const std::string& uri) const {
    if (uri.find("://") != std::string::npos) return uri.compare(0, 7, "file://") == 0;
    return uri.front() == '/' || !directory_.empty();
  }

  void check_named(const std::string& kind, const std::string& uri, const std::string& path) const {
    if (!can_find(uri)) return;
    try {
      check_file(kind, file_path(kind, uri, directory_, {}));
    } catch (const Error& error) {
      throw Error(nearest_setting(root_, path).place.describe() + ": " + path + ": " + error.what());
    }
  }

  const std::string& directory_;
  const Setting& root_;
};

}  // namespace

void check_files(const Case& read, const Setting& root) {
  const FileCheck files(read.directory, root);
  files.check(read.tank, "tank");
  for (std::size_t i = 0; i < read.bodies.size(); ++i) files.check(read.bodies[i], join_path("bodies", i));
  for (std::size_t i = 0; i < read.openings.size(); ++i) files.check(read.openings[i], join_path("openings", i));
}

}  // namespace wavetank::scene
