#include "stl_reader.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>

#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t header_bytes = 80, start_bytes = 84, triangle_bytes = 50, normal_bytes = 12;

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw Error("mesh file '" + path + "' cannot be read");
  return bytes;
}

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A number of a binary file, which has its least byte first.
std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (int k = 3; k >= 0; --k) number = number << 8 | static_cast<unsigned char>(bytes[at + k]);
  return number;
}

double coordinate_at(const std::string& bytes, std::size_t at) {
  const std::uint32_t number = number_at(bytes, at);
  float coordinate;
  std::memcpy(&coordinate, &number, sizeof coordinate);
  return coordinate;
}

/// How many triangles a binary file says it has.
std::size_t announced(const std::string& bytes) { return bytes.size() < start_bytes ? 0 : number_at(bytes, header_bytes); }

/// `comparisons`: that are left; 0 where they are not enough.
void add_facet(std::vector<Vector3d>& corners, TriangleMesh& mesh, std::uint64_t& comparisons) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  if (corners.size() == 3) {
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  } else {
    for (const Vector3i& t : triangulate(corners, &comparisons)) mesh.triangles.emplace_back(t + Vector3i::Constant(first));
  }
  corners.clear();
}

TriangleMesh read_binary(const std::string& bytes) {
  TriangleMesh mesh;
  const std::size_t count = announced(bytes);
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  std::vector<Vector3d> corners;
  std::uint64_t comparisons = most_comparisons;  // of which triangles need none
  for (std::size_t t = 0; t < count; ++t) {
    std::size_t at = start_bytes + t * triangle_bytes + normal_bytes;
    for (int k = 0; k < 3; ++k, at += 12)
      corners.emplace_back(coordinate_at(bytes, at), coordinate_at(bytes, at + 4), coordinate_at(bytes, at + 8));
    add_facet(corners, mesh, comparisons);
  }
  return mesh;
}

/// The words of a text, with the lines that they stand in.
class Words {
 public:
  Words(const std::string& text, std::size_t start) : text_(text), at_(start) {}

  /// In small letters; empty at the end.
  std::string next() {
    while (at_ < text_.size() && is_blank(text_[at_])) step();
    std::string word;
    for (; at_ < text_.size() && !is_blank(text_[at_]); ++at_) word += text_[at_];
    return lower(std::move(word));
  }

  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
  }

  std::size_t line() const { return line_; }

 private:
  void step() {  // a line ends with a line feed, a carriage return, or both
    if (text_[at_] == '\n' || (text_[at_] == '\r' && text_.compare(at_ + 1, 1, "\n") != 0)) ++line_;
    ++at_;
  }

  const std::string& text_;
  std::size_t at_;
  std::size_t line_ = 1;
};

/// Control characters are a binary file's; but some texts end with one.
bool is_text(const std::string& bytes) {
  return std::none_of(bytes.begin(), bytes.end() - 1, [](unsigned char c) { return c < 32 && !is_blank(static_cast<char>(c)); });
}

class TextReader {
 public:
  TextReader(const std::string& path, const std::string& text, std::size_t start) : path_(path), words_(text, start) {
    number_.imbue(std::locale::classic());
  }

  TriangleMesh read() {
    for (std::string word = words_.next(); !word.empty(); word = words_.next()) read_from(word);
    if (!corners_.empty() || within_facet_) fail("the text ends within a facet");
    return std::move(mesh_);
  }

 private:
  void read_from(std::string word) {
    if (word == "end") word += words_.next();  // "end solid"
    if (word == "vertex") {
      const double x = number(), y = number(), z = number();
      corners_.emplace_back(x, y, z);
    } else if (word == "facet") {
      if (!corners_.empty() || within_facet_) fail("a facet begins before the one before it ends");
      within_facet_ = true;
    } else if (word == "normal") {
      for (int k = 0; k < 3 && words_.next() != "outer"; ++k) continue;  // the vertices' turn says it; some writers leave the numbers out
    } else if (word == "endloop") {
      if (corners_.size() > most_corners)
        fail("a loop of " + std::to_string(corners_.size()) + " vertices; " + std::to_string(most_corners) + " at most are allowed");
      if (corners_.size() < 3) fail("a loop of " + std::to_string(corners_.size()) + " vertices; a facet has three or more");
      add_facet(corners_, mesh_, comparisons_);
      if (comparisons_ == 0) fail("the loops up to here have too many vertices to be cut into triangles in time; save it as triangles");
    } else if (word == "endfacet") {
      if (!corners_.empty()) fail("a facet ends before its loop does");
      within_facet_ = false;
    } else if (word == "solid" || word == "endsolid") {
      if (!corners_.empty() || within_facet_) fail("a solid begins or ends within a facet");
      words_.skip_line();  // its name
    } else if (word != "outer" && word != "loop" && word[0] >= ' ') {
      fail("'" + word.substr(0, 40) + "' stands where solid, facet, outer loop, vertex or the end of one of these must stand");
    }
  }

  double number() {
    const std::string word = words_.next();
    double value = 0;
    number_.clear();
    number_.str(word);
    if (!(number_ >> value) || !number_.eof()) {
      // The stream takes no nan and inf, and refuses what a double does not hold.
      fail(word.empty() ? "the text ends within a facet"
                        : "a coordinate reads '" + word.substr(0, 40) + "'; it must be a finite number such as -1.5e-3");
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw Error("mesh file '" + path_ + "' cannot be read: line " + std::to_string(words_.line()) + ": " + why);
  }

  const std::string& path_;
  Words words_;
  std::istringstream number_;
  TriangleMesh mesh_;
  std::vector<Vector3d> corners_;
  bool within_facet_ = false;
  std::uint64_t comparisons_ = most_comparisons;  ///< that are left
};

}  // namespace

bool is_stl(const std::string& path) {
  const std::string extension = lower(std::filesystem::path(path).extension().string());
  return extension == ".stl" || extension == ".stla" || extension == ".stlb";
}

TriangleMesh read_stl(const std::string& path) {
  const std::string bytes = read_bytes(path), unreadable = "mesh file '" + path + "' cannot be read: ";
  const std::size_t triangles = announced(bytes);
  if (bytes.size() >= start_bytes && bytes.size() == start_bytes + triangles * triangle_bytes) return read_binary(bytes);

  // A binary file may begin with "solid" too, but its length then is as above.
  if (bytes.compare(0, 2, "\xff\xfe") == 0 || bytes.compare(0, 2, "\xfe\xff") == 0)
    throw Error(unreadable + "its text has two bytes a character (UTF-16); save it as plain text or as a binary STL");
  std::size_t start = bytes.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
  while (start < bytes.size() && is_blank(bytes[start])) ++start;
  const std::string begin = lower(bytes.substr(start, 5));
  if ((begin == "solid" || begin == "facet") && is_text(bytes)) return TextReader(path, bytes, start).read();

  if (bytes.size() < start_bytes)
    throw Error(unreadable + "it is no STL: neither does it begin with solid, nor is it long enough for a binary one");
  const std::size_t whole = (bytes.size() - start_bytes) / triangle_bytes;
  if (triangles > whole) {
    throw Error(unreadable + "as a binary STL it announces " + std::to_string(triangles) + " triangles, but it ends after " +
                std::to_string(whole) + "; it is cut off or no STL");
  }
  return read_binary(bytes);  // something follows the triangles
}

}  // namespace wavetank
