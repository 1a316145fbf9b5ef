#include "ply_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

/// A kind of number in a PLY.
struct PlyKind {
  const char* name;
  const char* other_name;
  std::size_t bytes;
  bool is_signed, is_real;
};

constexpr PlyKind ply_kinds[] = {{"char", "int8", 1, true, false},    {"uchar", "uint8", 1, false, false},
                                 {"short", "int16", 2, true, false},  {"ushort", "uint16", 2, false, false},
                                 {"int", "int32", 4, true, false},    {"uint", "uint32", 4, false, false},
                                 {"float", "float32", 4, true, true}, {"double", "float64", 8, true, true}};

struct PlyProperty {
  std::string name;
  const PlyKind* kind = nullptr;
  const PlyKind* length = nullptr;  ///< of a list; none: a single number
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

bool is_ply_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string cut(const std::string& word) { return word.size() <= 40 ? word : word.substr(0, 40) + "…"; }

class PlyReader {
 public:
  PlyReader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) { number_.imbue(std::locale::classic()); }

  TriangleMesh read() {
    read_header();
    for (const PlyElement& element : elements_)
      if (element.name == "vertex") vertex_count_ = element.count;
    for (const PlyElement& element : elements_) read_element(element);
    if (!has_vertices_) fail("it has no element vertex");
    if (!has_faces_) fail("it has no element face with a list vertex_indices");
    for (const auto& [which, indices] : early_faces_) add_face(indices, which);
    return std::move(mesh_);
  }

 private:
  enum class Form { none, text, little, big };

  // ---- the header

  /// Ends with a line feed, a carriage return, or both.
  std::string header_line() {
    if (at_ >= bytes_.size()) fail("it ends within its header");
    const std::size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    const std::string line = bytes_.substr(at_, std::min<std::size_t>(end - at_, 4096));
    at_ = std::min(end + 1, bytes_.size());
    // What follows the header may begin with a line feed: after a carriage return it is the line's only where others had one too.
    if (end < bytes_.size() && bytes_[end] == '\n') has_line_feeds_ = true;
    const bool has_both = end < bytes_.size() && bytes_[end] == '\r' && at_ < bytes_.size() && bytes_[at_] == '\n';
    if (has_both && (has_line_feeds_ || line.substr(0, 10) != "end_header")) {
      has_line_feeds_ = true;
      ++at_;
    }
    ++line_;
    return line;
  }

  void read_header() {
    if (header_line().substr(0, 3) != "ply") fail("it does not begin with ply");
    while (true) {
      const std::string line = header_line();
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "end_header") break;
      if (word == "format")
        read_format(words);
      else if (word == "element")
        read_element_line(words);
      else if (word == "property")
        read_property(words);
      else if (!word.empty() && word != "comment" && word != "obj_info")
        fail("'" + cut(word) + "' stands where format, element, property, comment or end_header must stand");
    }
    if (form_ == Form::none) fail("its header has no line format");
    ++line_;  // of what follows
  }

  void read_format(std::istringstream& words) {
    std::string form;
    words >> form;
    form_ = form == "ascii"                  ? Form::text
            : form == "binary_little_endian" ? Form::little
            : form == "binary_big_endian"    ? Form::big
                                             : Form::none;
    if (form_ == Form::none) fail("its format is '" + cut(form) + "'; it must be ascii, binary_little_endian or binary_big_endian");
  }

  void read_element_line(std::istringstream& words) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const bool digits = !count.empty() && count.size() < 16 && count.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) fail("element " + cut(element.name) + " counts '" + cut(count) + "'; it must be a whole number");
    element.count = std::stoull(count);
    elements_.push_back(element);
  }

  const PlyKind* kind_of(const std::string& word) const {
    for (const PlyKind& kind : ply_kinds)
      if (word == kind.name || word == kind.other_name) return &kind;
    fail("a property is of '" + cut(word) + "'; it must be char, uchar, short, ushort, int, uint, float or double");
  }

  void read_property(std::istringstream& words) {
    if (elements_.empty()) fail("a property stands before the first element");
    PlyProperty property;
    std::string word;
    words >> word;
    if (word == "list") {
      words >> word;
      property.length = kind_of(word);
      if (property.length->is_real) fail("the length of a list is of '" + cut(word) + "'; it must be of a whole number");
      words >> word;
    }
    property.kind = kind_of(word);
    words >> property.name;
    elements_.back().properties.push_back(property);
  }

  // ---- what follows it

  /// The fewest bytes that one of an element takes.
  std::size_t least_bytes(const PlyElement& element) const {
    std::size_t least = 0;
    for (const PlyProperty& property : element.properties)
      least += form_ == Form::text ? 2 : property.length ? property.length->bytes : property.kind->bytes;
    return least;
  }

  void read_element(const PlyElement& element) {
    const std::size_t least = least_bytes(element), left = bytes_.size() - at_ + 1;  // a text's last blank may be missing
    if (element.count > 0 && least == 0) fail("element " + cut(element.name) + " has no properties");
    if (element.count > 0 && element.count > left / least)
      fail("it announces " + std::to_string(element.count) + " of element " + cut(element.name) + ", which its " +
           std::to_string(bytes_.size()) + " bytes do not hold; it is cut off or damaged");
    if (element.name == "vertex")
      read_vertices(element);
    else if (element.name == "face" || element.name == "tristrips")
      read_faces(element);
    else
      for (std::size_t k = 0; k < element.count; ++k)
        for (const PlyProperty& property : element.properties) skip(property, element, k);
  }

  void read_vertices(const PlyElement& element) {
    std::array<int, 3> places{-1, -1, -1};
    for (std::size_t k = 0; k < element.properties.size(); ++k)
      for (int axis = 0; axis < 3; ++axis)
        if (!element.properties[k].length && element.properties[k].name == std::string(1, static_cast<char>('x' + axis)))
          places[axis] = static_cast<int>(k);
    if (std::find(places.begin(), places.end(), -1) != places.end()) fail("its vertices have no properties x, y and z");
    has_vertices_ = true;
    for (std::size_t v = 0; v < element.count; ++v) {
      Vector3d vertex = Vector3d::Zero();
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const auto place = std::find(places.begin(), places.end(), static_cast<int>(k));
        if (place == places.end()) {
          skip(element.properties[k], element, v);
          continue;
        }
        const double value = next(*element.properties[k].kind, element, v);
        if (!std::isfinite(value)) fail("a coordinate of vertex " + std::to_string(v) + " is not a finite number");
        vertex[place - places.begin()] = value;
      }
      mesh_.vertices.push_back(vertex);
    }
  }

  void read_faces(const PlyElement& element) {
    const bool strips = element.name == "tristrips";
    const auto is_list = [](const PlyProperty& property) {
      return property.length != nullptr && (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_list)) fail("its faces have no list vertex_indices");
    has_faces_ = true;
    for (std::size_t f = 0; f < element.count; ++f)
      for (const PlyProperty& property : element.properties) {
        if (!is_list(property)) {
          skip(property, element, f);
          continue;
        }
        const std::vector<int> indices = index_list(property, element, f, strips);
        if (strips)
          add_strips(indices);
        else if (has_vertices_)
          add_face(indices, f);
        else
          early_faces_.emplace_back(f, indices);
      }
  }

  std::size_t list_length(const PlyProperty& property, const PlyElement& element, std::size_t which) {
    const double length = next(*property.length, element, which);
    const std::size_t least = form_ == Form::text ? 2 : property.kind->bytes;
    if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>((bytes_.size() - at_ + 1) / least))
      fail(described(element, which) + " has a list of " + describe(length) + ", which the rest of the file does not hold");
    return static_cast<std::size_t>(length);
  }

  std::vector<int> index_list(const PlyProperty& property, const PlyElement& element, std::size_t which, bool strips) {
    std::vector<int> indices(list_length(property, element, which));
    for (int& index : indices) {
      const double value = next(*property.kind, element, which);
      const bool exists = value >= 0 && value == std::floor(value) && value < static_cast<double>(vertex_count_);
      if (!exists && !(strips && value == -1))
        fail(described(element, which) + " names vertex " + describe(value) + ", which does not exist: there are " +
             std::to_string(vertex_count_));
      index = static_cast<int>(value);
    }
    return indices;
  }

  void add_face(const std::vector<int>& indices, std::size_t which) {
    if (indices.size() < 3) return;  // points and lines bound nothing
    if (indices.size() == 3) {
      mesh_.triangles.emplace_back(indices[0], indices[1], indices[2]);
      return;
    }
    if (indices.size() > most_corners)
      fail("face " + std::to_string(which) + " has " + std::to_string(indices.size()) + " corners; " + std::to_string(most_corners) +
           " at most are allowed");
    std::vector<Vector3d> corners;
    corners.reserve(indices.size());
    for (const int index : indices) corners.push_back(mesh_.vertices[index]);
    const std::vector<Vector3i> triangles = triangulate(corners, &comparisons_);
    if (comparisons_ == 0)
      fail("the faces up to face " + std::to_string(which) +
           " have too many corners to be cut into triangles in time; save it as triangles");
    for (const Vector3i& t : triangles) mesh_.triangles.emplace_back(indices[t[0]], indices[t[1]], indices[t[2]]);
  }

  /// −1 begins a new strip; every other triangle of one is turned.
  void add_strips(const std::vector<int>& indices) {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < indices.size(); ++k) {
      if (indices[k] < 0) begin = k + 1;
      if (k < begin + 2) continue;
      const bool turned = (k - begin) % 2 == 1;
      mesh_.triangles.emplace_back(indices[k - 2], indices[turned ? k : k - 1], indices[turned ? k - 1 : k]);
    }
  }

  void skip(const PlyProperty& property, const PlyElement& element, std::size_t which) {
    std::size_t count = property.length ? list_length(property, element, which) : 1;
    if (form_ == Form::text) {
      for (; count > 0; --count) word(element, which);
    } else {
      take(count * property.kind->bytes, element, which);
    }
  }

  std::string described(const PlyElement& element, std::size_t which) const { return cut(element.name) + " " + std::to_string(which); }

  double next(const PlyKind& kind, const PlyElement& element, std::size_t which) {
    if (form_ != Form::text) return binary_number(kind, take(kind.bytes, element, which));
    const std::string text = word(element, which);
    double value = 0;
    number_.clear();
    number_.str(text);
    if (!(number_ >> value) || !number_.eof())
      fail(described(element, which) + " has '" + cut(text) + "' where a finite number such as -1.5e-3 must stand");
    return value;
  }

  std::string word(const PlyElement& element, std::size_t which) {
    for (; at_ < bytes_.size() && is_ply_blank(bytes_[at_]); ++at_)
      if (bytes_[at_] == '\n' || (bytes_[at_] == '\r' && bytes_.compare(at_ + 1, 1, "\n") != 0)) ++line_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_ply_blank(bytes_[at_])) ++at_;
    if (begin == at_) fail("it ends within " + described(element, which));
    return bytes_.substr(begin, at_ - begin);
  }

  const char* take(std::size_t length, const PlyElement& element, std::size_t which) {
    if (length > bytes_.size() - at_) fail("it ends within " + described(element, which));
    at_ += length;
    return bytes_.data() + at_ - length;
  }

  double binary_number(const PlyKind& kind, const char* from) const {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < kind.bytes; ++k) {
      const std::size_t place = form_ == Form::little ? kind.bytes - 1 - k : k;  // the most significant first
      bits = bits << 8 | static_cast<unsigned char>(from[place]);
    }
    if (kind.is_real && kind.bytes == 8) {
      double value;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    if (kind.is_real) {
      const auto narrow = static_cast<std::uint32_t>(bits);
      float value;
      std::memcpy(&value, &narrow, sizeof value);
      return value;
    }
    const auto range = static_cast<double>(std::uint64_t(1) << (8 * kind.bytes));
    const auto value = static_cast<double>(bits);
    return kind.is_signed && value >= 0.5 * range ? value - range : value;
  }

  [[noreturn]] void fail(const std::string& why) const {
    const bool has_line = form_ == Form::text || !has_begun();
    throw Error("mesh file '" + path_ + "' cannot be read: " + (has_line ? "line " + std::to_string(std::max(line_, 1)) + ": " : "") + why);
  }

  bool has_begun() const { return has_vertices_ || has_faces_; }

  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
  bool has_line_feeds_ = false;  ///< a line of the header had one
  Form form_ = Form::none;
  std::vector<PlyElement> elements_;
  bool has_vertices_ = false, has_faces_ = false;
  std::size_t vertex_count_ = 0;
  std::vector<std::pair<std::size_t, std::vector<int>>> early_faces_;  ///< that stand before the vertices
  std::uint64_t comparisons_ = most_comparisons;                       ///< that are left
  std::istringstream number_;
  TriangleMesh mesh_;
};

}  // namespace

bool is_ply(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".ply") return true;
  std::ifstream file(path, std::ios::binary);
  std::string head(4, ' ');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == "ply\n" || head == "ply\r";
}

TriangleMesh read_ply(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw Error("mesh file '" + path + "' cannot be read");
  return PlyReader(path, bytes).read();
}

}  // namespace wavetank
