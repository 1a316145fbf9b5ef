#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wavetank {

/// Points with values, and the vertices, lines or triangles that they are the corners of, as VTK's XML files of polygons (.vtp) hold them.
struct VtkPolygons {
  using Values = std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint8_t>, std::vector<std::uint32_t>,
                              std::vector<std::string>>;
  struct Field {
    std::string name;
    int components = 1;   ///< of each point, one after the other in `values`
    Values values;        ///< texts have one component
    bool packed = false;  ///< worth packing: few different values, or such that differ little
  };
  enum class Cells { vertices, lines, triangles };

  Cells cells = Cells::vertices;
  Values points;  ///< x y z of each, m, float or double; two in a row make a line, three a triangle
  std::vector<Field> fields;
};

/// The file's content: numbers as they lie in memory, after the XML, in zlib's blocks. Throws Error where a field does not have a value of
/// each component for each point.
std::string vtp_content(const VtkPolygons& polygons);

/// Files of a run by their times, as ParaView's collections (.pvd) list them.
class VtkCollection {
 public:
  /// `part`: which of the blocks of this time; `file`: relative to the collection's folder.
  void add(double time, int part, const std::string& name, const std::string& file);
  std::string content() const;
  int count() const { return count_; }

 private:
  std::string entries_;
  int count_ = 0;
};

/// Where `&`, `<`, `>` and `"` are written as XML has them.
std::string xml_text(std::string_view text);

}  // namespace wavetank
