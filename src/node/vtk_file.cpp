#include "wavetank/node/vtk_file.h"

#include <zlib.h>

#include <cstdio>
#include <cstring>

#include "wavetank/common/error.h"

namespace wavetank {

namespace {

/// Data arrays of a file: each one's line of XML, and the bytes that all lines point into.
class AppendedArrays {
 public:
  /// The array's line. `bytes`: its values as they lie in memory.
  std::string add(const std::string& type, const std::string& name, int components, std::string_view bytes, bool packed) {
    const std::string line = "<DataArray type=\"" + type + "\" Name=\"" + xml_text(name) + "\" NumberOfComponents=\"" +
                             std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) + "\"/>\n";
    append_block(bytes, packed);
    return line;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  /// One block of zlib's after its head: how many blocks there are, their length, that of a shorter last one, and the packed lengths.
  void append_block(std::string_view bytes, bool packed) {
    if (bytes.empty()) {
      append_number(0);
      return;
    }
    // What packs badly is stored in zlib's own form, which costs no time.
    const int level = packed ? 1 : 0;
    uLongf length = compressBound(bytes.size());
    std::string block(length, '\0');
    if (compress2(reinterpret_cast<Bytef*>(block.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), level) !=
        Z_OK)
      throw Error("zlib could not pack " + std::to_string(bytes.size()) + " bytes for a file for ParaView");
    for (const std::uint64_t number :
         {std::uint64_t{1}, static_cast<std::uint64_t>(bytes.size()), std::uint64_t{0}, static_cast<std::uint64_t>(length)})
      append_number(number);
    bytes_.append(block, 0, length);
  }
  void append_number(std::uint64_t number) { bytes_.append(reinterpret_cast<const char*>(&number), sizeof number); }

  std::string bytes_;
};

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

const char* vtk_type(const std::vector<float>&) { return "Float32"; }
const char* vtk_type(const std::vector<double>&) { return "Float64"; }
const char* vtk_type(const std::vector<std::uint8_t>&) { return "UInt8"; }
const char* vtk_type(const std::vector<std::uint32_t>&) { return "UInt32"; }
const char* vtk_type(const std::vector<std::int32_t>&) { return "Int32"; }

template <class Value>
std::string array_line(AppendedArrays& arrays, const std::string& name, int components, const std::vector<Value>& values, bool packed) {
  return arrays.add(vtk_type(values), name, components, bytes_of(values), packed);
}

std::string array_line(AppendedArrays& arrays, const std::string& name, int, const std::vector<std::string>& texts, bool packed) {
  std::string joined;
  for (const std::string& text : texts) joined += text + '\0';
  std::string line = arrays.add("String", name, 1, joined, packed);
  const std::string ending = "/>\n";
  return line.replace(line.size() - ending.size(), ending.size(), " NumberOfTuples=\"" + std::to_string(texts.size()) + "\"/>\n");
}

std::size_t length_of_values(const VtkPolygons::Values& values) {
  return std::visit([](const auto& each) { return each.size(); }, values);
}

bool is_little_endian() {
  const std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '&')
      result += "&amp;";
    else if (letter == '<')
      result += "&lt;";
    else if (letter == '>')
      result += "&gt;";
    else if (letter == '"')
      result += "&quot;";
    else
      result += letter;
  }
  return result;
}

std::string vtp_content(const VtkPolygons& polygons) {
  const std::size_t points = length_of_values(polygons.points) / 3;
  const std::size_t corners = polygons.cells == VtkPolygons::Cells::triangles ? 3 : polygons.cells == VtkPolygons::Cells::lines ? 2 : 1;
  const char* const kind = polygons.cells == VtkPolygons::Cells::triangles ? "Polys"
                           : polygons.cells == VtkPolygons::Cells::lines   ? "Lines"
                                                                           : "Verts";
  AppendedArrays arrays;
  std::string body = "<PointData>\n";
  for (const VtkPolygons::Field& field : polygons.fields) {
    if (length_of_values(field.values) != points * static_cast<std::size_t>(field.components))
      throw Error("field '" + field.name + "' of a file for ParaView does not have as many values as there are points");
    body += std::visit([&](const auto& values) { return array_line(arrays, field.name, field.components, values, field.packed); },
                       field.values);
  }
  body += "</PointData>\n<Points>\n";
  body += std::visit([&](const auto& values) { return array_line(arrays, "points", 3, values, false); }, polygons.points);
  // One cell of all points costs less than one of each, and is drawn alike.
  const std::size_t cells = corners == 1 ? (points > 0 ? 1 : 0) : points / corners;
  std::vector<std::int32_t> connectivity(corners == 1 ? points : cells * corners), offsets(cells);
  for (std::size_t i = 0; i < connectivity.size(); ++i) connectivity[i] = static_cast<std::int32_t>(i);
  for (std::size_t i = 0; i < cells; ++i) offsets[i] = static_cast<std::int32_t>(corners == 1 ? points : (i + 1) * corners);
  body += std::string("</Points>\n<") + kind + ">\n" + array_line(arrays, "connectivity", 1, connectivity, true) +
          array_line(arrays, "offsets", 1, offsets, true) + "</" + kind + ">\n";
  std::string head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
  head += is_little_endian() ? "LittleEndian" : "BigEndian";
  head += "\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n<Piece NumberOfPoints=\"" + std::to_string(points) +
          "\"";
  for (const char* each : {"Verts", "Lines", "Strips", "Polys"})
    head += std::string(" NumberOf") + each + "=\"" + std::to_string(std::strcmp(each, kind) == 0 ? cells : 0) + "\"";
  return head + ">\n" + body + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + arrays.bytes() +
         "\n</AppendedData>\n</VTKFile>\n";
}

void VtkCollection::add(double time, int part, const std::string& name, const std::string& file) {
  char shown[32];
  std::snprintf(shown, sizeof shown, "%.9g", time);
  entries_ += std::string("<DataSet timestep=\"") + shown + "\" part=\"" + std::to_string(part) + "\" name=\"" + xml_text(name) +
              "\" file=\"" + xml_text(file) + "\"/>\n";
  ++count_;
}

std::string VtkCollection::content() const {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" + entries_ +
         "</Collection>\n</VTKFile>\n";
}

}  // namespace wavetank
