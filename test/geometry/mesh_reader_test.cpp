#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "geometry_fixture.h"

namespace wavetank::mesh_reader_test {
namespace {

const Box unit_cube{Vector3d::Zero(), Vector3d::Ones()};

class MeshReader : public GeometryTest {};

TriangleMesh read(const MeshSource& from) { return read_mesh(from, "", ResourceResolver()); }

/// A Collada cube face: one triangle, with the given unit and axis, under a node that moves it.
std::string collada(const std::string& unit, const std::string& up_axis, const std::string& matrix) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="u" meter=")" +
         unit + R"("/><up_axis>)" + up_axis +
         R"(</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 0 2</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="s"><node id="n"><matrix>)" +
         matrix +
         R"(</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshReader, ReadsStlAndMergesItsVertices) {
  const TriangleMesh box = read(source(repository_mesh("spheric2_box.stl")));
  EXPECT_EQ(box.name, "spheric2_box.stl");
  EXPECT_EQ(box.triangles.size(), 12u);
  EXPECT_EQ(box.vertices.size(), 8u);
  EXPECT_NEAR(box.signed_volume(), 0.161 * 0.403 * 0.161, 1e-8);
  EXPECT_TRUE(box.bounding_box().min.isApprox(Vector3d(0.6635, 0.2985, 0), 1e-6));
}

TEST_F(MeshReader, ReadsPlyAndOff) {
  const std::string ply =
      write("t.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0\n2 0 0\n0 3 0\n3 0 1 2\n");
  EXPECT_NEAR(surface_area(read(source(ply))), 3.0, 1e-12);
  const std::string off = write("t.off", "OFF\n3 1 0\n0 0 0\n2 0 0\n0 3 0\n3 0 1 2\n");
  EXPECT_NEAR(surface_area(read(source(off))), 3.0, 1e-12);
}

TEST_F(MeshReader, ScalesThenRotatesThenTranslates) {
  MeshSource from = source(write("box.obj", box_mesh({Vector3d::Zero(), Vector3d(1000, 2000, 3000)}, false, "")));
  from.scale = Vector3d::Constant(1e-3);
  from.rotation = Vector3d(0, 0, M_PI / 2);  // x to y, y to −x
  from.translation = Vector3d(10, 20, 30);
  const Box box = read(from).bounding_box();
  EXPECT_TRUE(box.min.isApprox(Vector3d(8, 20, 30), 1e-9)) << box.min.transpose();
  EXPECT_TRUE(box.max.isApprox(Vector3d(10, 21, 33), 1e-9)) << box.max.transpose();
}

TEST_F(MeshReader, MirrorsAndStretches) {
  // A wedge in millimetres: the half of a box of 0.2 × 0.15 × 0.1 m below its diagonal.
  TriangleMesh wedge;
  for (const double y : {0.0, 150.0})
    for (const Vector3d& corner : {Vector3d(0, y, 0), Vector3d(200, y, 0), Vector3d(0, y, 100)}) wedge.vertices.push_back(corner);
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}, {2, 5, 0}, {0, 5, 3}};
  MeshSource from = source(write("wedge_mm.obj", wedge));
  for (const Vector3d& signs : {Vector3d(1, 1, 1), Vector3d(1, -1, 1), Vector3d(-1, -1, 1), Vector3d(-1, -1, -1)}) {
    from.scale = 1e-3 * signs;
    const TriangleMesh mesh = read(from);
    EXPECT_NEAR(mesh.signed_volume(), 0.0015, 1e-12) << signs.transpose();
    EXPECT_LT((mesh.centre_of_volume() - signs.cwiseProduct(Vector3d(0.2 / 3, 0.075, 0.1 / 3))).norm(), 1e-12) << signs.transpose();
  }
  from.scale = Vector3d(0.002, 0.003, -0.0005);
  EXPECT_NEAR(read(from).signed_volume(), 0.0045, 1e-12);
}

TEST_F(MeshReader, RotatesAboutFixedAxesRollFirst) {
  MeshSource from = source(write("box.obj", box_mesh({Vector3d::Zero(), Vector3d(1, 2, 3)}, false, "")));
  from.rotation = Vector3d(M_PI / 2, 0, M_PI / 2);  // roll: y to z, z to −y; then yaw: x to y, −y to x
  const Box box = read(from).bounding_box();
  EXPECT_TRUE((box.min - Vector3d(0, 0, 0)).norm() < 1e-9) << box.min.transpose();
  EXPECT_TRUE((box.max - Vector3d(3, 1, 2)).norm() < 1e-9) << box.max.transpose();
}

TEST_F(MeshReader, JoinsSubmeshes) {
  std::string obj;
  for (const char* name : {"left", "right"}) {
    obj += std::string("o ") + name + "\nv " + (name[0] == 'l' ? "0 0 0\nv 1 0 0\nv 1 1 0\n" : "0 0 0\nv 1 1 0\nv 0 1 0\n");
  }
  obj += "o left\nf 1 2 3\no right\nf 4 5 6\n";
  const TriangleMesh mesh = read(source(write("two.obj", obj)));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u) << "the shared corners must be one vertex each";
  EXPECT_NEAR(surface_area(mesh), 1.0, 1e-12);
}

TEST_F(MeshReader, AppliesColladaUnitAndNodesButKeepsItsAxes) {
  const std::string moved = "1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1";
  for (const char* axis : {"Z_UP", "Y_UP"}) {
    const Box box = read(source(write("t.dae", collada("0.01", axis, moved)))).bounding_box();
    EXPECT_TRUE((box.min - Vector3d(0.05, 0.06, 0.07)).norm() < 1e-6) << axis << ": " << box.min.transpose();
    EXPECT_TRUE((box.max - Vector3d(0.06, 0.06, 0.09)).norm() < 1e-6) << axis << ": " << box.max.transpose();
  }
}

/// A Collada file of one square of 2 m² as a polylist, with what else stands in it.
std::string square_collada(const std::string& libraries, const std::string& scene) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="m" meter="1"/>
<up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">0 0 0 1 0 0 1 2 0 0 2 0
</float_array><technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry>
</library_geometries>)" +
         libraries + R"(<library_visual_scenes><visual_scene id="s">)" + scene +
         R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshReader, TakesAColladaNodeOfTheNameOfOneThatItHolds) {
  const std::string wheel = R"(<library_nodes><node id="wheel"><instance_geometry url="#g"/></node></library_nodes>)",
                    named = R"(<node id="ID1" name="wheel"><instance_node url="#wheel"/></node>)";
  EXPECT_NEAR(surface_area(read(source(write("named.dae", square_collada(wheel, named))))), 2, 1e-6);
  EXPECT_ERROR(read(source(write("itself.dae", square_collada("", named)))), "node 'ID1' holds itself");
  const std::string ring =
      R"(<node id="a"><instance_node url="#b"/></node><node id="b"><node id="c"><instance_node url="#a"/></node></node>)";
  EXPECT_ERROR(read(source(write("ring.dae", square_collada("", ring)))), "holds itself");
}

TEST_F(MeshReader, KnowsColladaAndPlyByTheirContent) {
  const std::string sound = square_collada("", R"(<node><instance_geometry url="#g"/></node>)");
  std::string damaged = sound;
  damaged.replace(damaged.find("<p>0 1"), 6, "<p>0 .0");
  for (const char* name : {"box.xml", "box", "box.mesh.bin"}) {
    EXPECT_NEAR(surface_area(read(source(write(name, sound)))), 2, 1e-6) << name;
    EXPECT_ERROR(read(source(write(name, damaged))), "where a whole number from 0 on must stand");
  }
  std::string wide = "\xff\xfe";
  for (const char c : sound) wide += {c, '\0'};
  for (const char* name : {"wide.dae", "wide"}) EXPECT_ERROR(read(source(write(name, wide))), "save it as UTF-8");
  EXPECT_ERROR(read(source(write("box.zae", std::string("PK\3\4") + sound))), "give the .dae that is in it");
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face 1\n"
      "property list uchar uchar vertex_indices\nend_header\n" +
      std::string("\n\0\0\0\0\0\0\2\0\3\0\1\2", 13);  // whose first byte is a line feed, which assimp skips
  EXPECT_NEAR(surface_area(read(source(write("first_byte", ply)))), 10, 1e-9);
}

TEST_F(MeshReader, TakesAColladaController) {
  const std::string
      skin = R"(<library_controllers><controller id="k"><skin source="#g"><source id="j"><Name_array id="ja" count="1">bone</Name_array>
<technique_common><accessor source="#ja" count="1" stride="1"><param name="JOINT" type="name"/></accessor></technique_common></source>
<source id="b"><float_array id="ba" count="16">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>
<accessor source="#ba" count="1" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
<source id="w"><float_array id="wa" count="1">1</float_array><technique_common><accessor source="#wa" count="1" stride="1">
<param name="WEIGHT" type="float"/></accessor></technique_common></source>
<joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#b"/></joints>
<vertex_weights count="4"><input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>
<vcount>1 1 1 1</vcount><v>0 0 0 0 0 0 0 0</v></vertex_weights></skin></controller></library_controllers>)",
      scene = R"(<node id="bone" sid="bone" type="JOINT"/><node id="n"><instance_controller url="#k"><skeleton>#bone</skeleton>
</instance_controller></node>)";
  EXPECT_NEAR(surface_area(read(source(write("skin.dae", square_collada(skin, scene))))), 2, 1e-6);
}

TEST_F(MeshReader, RefusesColladaNodesThatHoldEachOtherTooDeep) {
  std::string chain;
  for (int k = 0; k < 600; ++k)
    chain += "<node id='n" + std::to_string(k) + "'><instance_node url='#n" + std::to_string(k + 1) + "'/></node>\n";
  EXPECT_ERROR(read(source(write("chain.dae", square_collada(chain, "")))), "nodes hold each other more than 500 deep");
}

TEST_F(MeshReader, CutsPolygonsIntoTriangles) {
  const std::string arrow = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n";  // a square with a deep notch
  const TriangleMesh mesh = read(source(write("arrow.obj", arrow)));
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_NEAR(surface_area(mesh), 4 - 1.5, 1e-12);
}

TEST_F(MeshReader, DropsDuplicatesAndZeroAreas) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 2 3 1\nf 3 2 1\nf 1 2 4\nf 1 1 2\n";
  const TriangleMesh mesh = read(source(write("t.obj", obj)));
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST_F(MeshReader, FindsFilesByEveryKindOfAddress) {
  const std::string path = write("a box.obj", box_mesh(unit_cube, false, ""));
  const auto resolve = [&](const std::string& uri) {
    return uri == "package://tank/a box.obj" ? "file://" + path : std::string("/nowhere.obj");
  };
  EXPECT_EQ(read_mesh(source(path), "", resolve).triangles.size(), 12u);
  EXPECT_EQ(read_mesh(source("file://" + (directory / "a%20box.obj").string()), "", resolve).triangles.size(), 12u);
  EXPECT_EQ(read_mesh(source("a box.obj"), directory.string(), resolve).triangles.size(), 12u);
  EXPECT_EQ(read_mesh(source("package://tank/a box.obj"), "", resolve).triangles.size(), 12u);
  EXPECT_ERROR(read_mesh(source("package://other/a.obj"), "", resolve), "'/nowhere.obj' does not exist");
  EXPECT_ERROR(read(source("package://tank/a box.obj")), "nothing here resolves");
  EXPECT_ERROR(read(source("a box.obj")), "relative path, which needs a case file");
  EXPECT_ERROR(read(source("")), "empty path");
}

TEST_F(MeshReader, RefusesWhatIsNoMesh) {
  EXPECT_ERROR(read(source((directory / "none.stl").string())), "does not exist");
  EXPECT_ERROR(read(source(directory.string())), "not a regular file");
  EXPECT_ERROR(read(source(write("empty.stl", ""))), "is empty");
  EXPECT_ERROR(read(source(write("text.dae", "this is no mesh"))), "cannot be read");
  EXPECT_ERROR(read(source(write("tank.xyz123", "0 0 0"))), "cannot be read");
  EXPECT_ERROR(read(source(write("points.obj", "v 0 0 0\nv 1 0 0\n"))), "points.obj");
  EXPECT_ERROR(read(source(write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"))), "zero area");
  EXPECT_ERROR(read(source(write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"))), "nan.obj");
}

TEST_F(MeshReader, RefusesATruncatedBinaryStl) {
  std::ifstream whole(repository_mesh("spheric2_box.stl"), std::ios::binary);
  std::stringstream bytes;
  bytes << whole.rdbuf();
  EXPECT_ERROR(read(source(write("cut.stl", bytes.str().substr(0, 300)))), "cannot be read");
}

/// A cube of side 2 about the origin as an STL text; `solid`, `facet` and so on as given by `spell`.
template <class Spell>
std::string stl_text(Spell spell, const std::string& start, const std::string& end, const std::string& line_end = "\n") {
  const TriangleMesh cube = box_mesh({-Vector3d::Ones(), Vector3d::Ones()}, false, "");
  std::ostringstream text;
  text << start << line_end;
  for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
    text << "  " << spell("facet normal 0 0 0") << line_end << "\t" << spell("outer loop") << line_end;
    for (int k = 0; k < 3; ++k) {
      text << spell("vertex");
      for (int axis = 0; axis < 3; ++axis) text << " " << cube.corner(t, k)[axis];
      text << line_end;
    }
    text << spell("endloop") << line_end << spell("endfacet") << line_end;
  }
  text << end;
  return text.str();
}

std::string as_is(const std::string& word) { return word; }
std::string in_capitals(std::string word) {
  for (char& c : word) c = static_cast<char>(std::toupper(c));
  return word;
}

std::string stl_binary(const std::string& header, char attribute, const std::string& more = "") {
  const TriangleMesh cube = box_mesh({-Vector3d::Ones(), Vector3d::Ones()}, false, "");
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += std::string({12, 0, 0, 0});
  for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
    bytes += std::string(12, '\0');
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const float coordinate = static_cast<float>(cube.corner(t, k)[axis]);
        bytes.append(reinterpret_cast<const char*>(&coordinate), sizeof coordinate);
      }
    }
    bytes += std::string(2, attribute);
  }
  return bytes + more;
}

TEST_F(MeshReader, ReadsEveryDialectOfStl) {
  const std::string plain = stl_text(as_is, "solid cube", "endsolid cube\n");
  const std::pair<const char*, std::string> dialects[] = {
      {"plain", plain},
      {"capitals", stl_text(in_capitals, "SOLID FACE0", "ENDSOLID FACE0\n")},
      {"mixed", stl_text(
                    [](std::string word) {
                      word[0] = static_cast<char>(std::toupper(word[0]));
                      return word;
                    },
                    "Solid x", "EndSolid")},
      {"no endsolid", stl_text(as_is, "solid", "")},
      {"another endsolid", stl_text(as_is, "solid a", "endsolid of something else facet vertex")},
      {"end in two words", stl_text(as_is, "solid a", "end solid a")},
      {"no solid", stl_text(as_is, "", "endsolid")},
      {"a name of keywords", stl_text(as_is, "solid facet vertex endloop", "endsolid facet")},
      {"leading blanks", " \r\n\t\n " + plain},
      {"a byte-order mark", "\xef\xbb\xbf" + plain},
      {"both", "\xef\xbb\xbf \n" + plain},
      {"carriage returns", stl_text(as_is, "solid a", "endsolid a", "\r")},
      {"both line ends", stl_text(as_is, "solid a", "endsolid a\r\n", "\r\n")},
      {"an end of DOS", plain + "\x1a"},
      {"no values of the normal",
       stl_text([](const std::string& word) { return word == "facet normal 0 0 0" ? "facet normal" : word; }, "solid", "endsolid")},
      {"binary", stl_binary("made by hand", 0)},
      {"binary that begins with solid", stl_binary("solid cube", 0)},
      {"binary with colours", stl_binary("COLOR=\x10\x20\x30\xff,MATERIAL=", '\x7f')},
      {"binary with something behind", stl_binary("solid", 0, "more")},
  };
  for (const auto& [what, text] : dialects) {
    SCOPED_TRACE(what);
    const TriangleMesh cube = read(source(write("cube.STL", text)));
    EXPECT_EQ(cube.triangles.size(), 12u);
    EXPECT_EQ(cube.vertices.size(), 8u);
    EXPECT_NEAR(cube.signed_volume(), 8, 1e-12);
  }
}

TEST_F(MeshReader, JoinsTheSolidsOfAnStlText) {
  const std::string capitals = stl_text(in_capitals, "SOLID A", "ENDSOLID A\n");
  const auto far = [](const std::string& word) { return word == "vertex" ? std::string("vertex 1") : word; };  // shifts x, y and drops z
  EXPECT_EQ(read(source(write("two.stl", capitals + stl_text(as_is, "solid b", "")))).triangles.size(), 12u);
  EXPECT_ERROR(read(source(write("four.stl", stl_text(far, "solid", "endsolid")))), "line 4: '-1' stands where solid, facet, outer loop");
}

TEST_F(MeshReader, RefusesStlTextsInPlainWords) {
  const auto refuses = [&](const std::string& text, const std::string& why) {
    EXPECT_ERROR(read(source(write("t.stl", text))), "t.stl' cannot be read: " + why);
  };
  const std::string facet = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  refuses(facet + "facet normal 0 0 0\nouter loop\nvertex 0 0", "line 11: the text ends within a facet");
  refuses(facet + "facet normal 0 0 0\nouter loop\nvertex 0 0 0\n", "line 12: the text ends within a facet");
  refuses("solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 x\n", "line 4: a coordinate reads 'x'; it must be a finite number");
  refuses("solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1,5\n", "line 4: a coordinate reads '1,5'");
  refuses("solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 nan\n", "line 4: a coordinate reads 'nan'");
  refuses("solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1e999\n", "line 4: a coordinate reads '1e999'");
  refuses("solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1\nvertex 0 1 1\nendloop\n", "line 6: a loop of 2 vertices");
  refuses("solid a\nface 1 2 3\n", "line 2: 'face' stands where");
  refuses(std::string("\xff\xfes\0o\0l\0i\0d\0", 12), "its text has two bytes a character (UTF-16)");
  refuses("a picture of a cube", "it is no STL");
  refuses(stl_binary("solid", 0).substr(0, 300), "as a binary STL it announces 12 triangles, but it ends after 4");
  EXPECT_ERROR(read(source(write("none.stl", "solid a\nendsolid a\n"))), "none.stl' has no triangles");
}

TEST_F(MeshReader, ReadsEveryDialectOfPly) {
  const std::string head =
      "comment by hand\nelement vertex 4\nproperty float32 x\nproperty double y\nproperty short z\nproperty uchar red\n";
  const std::string faces = "element face 1\nproperty list uchar uint vertex_index\nproperty float quality\nend_header\n";
  const std::string square = "ply\nformat ascii 1.0\n" + head + faces + "0 0 0 255\n2 0 0 7\n2 1 0 7\n0 1 0 7\n4 0 1 2 3 0.5\n";
  EXPECT_NEAR(surface_area(read(source(write("t.ply", square)))), 2.0, 1e-12);
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const std::string strip = "ply\nformat ascii 1.0\n" + head + strips + "0 0 0 255\n2 0 0 7\n0 1 0 7\n2 1 0 7\n5 0 1 2 3 -1\n";
  const TriangleMesh two = read(source(write("s.ply", strip)));
  ASSERT_EQ(two.triangles.size(), 2u);
  for (std::size_t t = 0; t < 2; ++t)
    EXPECT_GT((two.corner(t, 1) - two.corner(t, 0)).cross(two.corner(t, 2) - two.corner(t, 0)).z(), 0) << t;
}

TEST_F(MeshReader, TakesPlyFacesBeforeVerticesAndMixedLineEnds) {
  const std::string faces = "element face 1\nproperty list uchar uchar vertex_indices\n",
                    vertices = "element vertex 4\nproperty uchar x\nproperty uchar y\nproperty uchar z\n", body = "4 0 1 2 3\n",
                    corners = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n";
  EXPECT_NEAR(
      surface_area(read(source(write("early.ply", "ply\nformat ascii 1.0\n" + faces + vertices + "end_header\n" + body + corners)))), 2,
      1e-12);
  EXPECT_ERROR(read(source(write("early.ply", "ply\nformat ascii 1.0\n" + faces + vertices + "end_header\n4 0 1 2 4\n" + corners))),
               "names vertex 4, which does not exist: there are 4");
  const std::string data("\0\0\0\2\0\0\2\1\0\0\1\0\4\0\1\2\3", 17);
  EXPECT_NEAR(surface_area(read(
                  source(write("mixed.ply", "ply\nformat binary_little_endian 1.0\r\n" + vertices + faces + "end_header\r\n" + data)))),
              2, 1e-12);
}

TEST_F(MeshReader, RefusesPlyTextsInPlainWords) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n", places = "0 0 0\n1 0 0\n0 1 0\n";
  const auto refuses = [&](const std::string& text, const std::string& why) {
    EXPECT_ERROR(read(source(write("t.ply", text))), "t.ply' cannot be read: " + why);
  };
  refuses(head + faces + places + "3 0 1 3\n", "line 13: face 0 names vertex 3, which does not exist: there are 3");
  refuses(head + faces + places + "3 0 1 1.5\n", "line 13: face 0 names vertex 1.5");
  refuses(head + faces + places + "9999 0 1 2\n", "line 13: face 0 has a list of 9999, which the rest of the file does not hold");
  refuses(head + faces + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "line 11: vertex 1 has 'nan'");
  refuses(head + faces + "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "line 11: vertex 1 has 'x'");
  refuses(head + faces + places, "line 13: it ends within face 0");
  refuses("ply\nformat ascii 1.0\nelement vertex 1e9\n", "line 3: element vertex counts '1e9'; it must be a whole number");
  refuses("ply\nformat ascii 1.0\nelement face 3\nend_header\n1 2 3\n", "line 5: element face has no properties");
  refuses("ply\nproperty list float int vertex_indices\n", "line 2: a property stands before the first element");
  refuses("ply\nformat utf16 1.0\n", "line 2: its format is 'utf16'");
  refuses(head + "end_header\n" + places, "line 10: it has no element face");
  refuses("solid a\n", "line 1: it does not begin with ply");
}

// Names of nodes and materials come through the process that reads them.
TEST_F(MeshReader, KeepsPartsThroughTheReadersProcess) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng left\nf 1 2 3\ng right\nf 1 3 4\n";
  const TriangleMesh mesh = read_mesh(source(write("t.obj", obj)), "", ResourceResolver(), {"right"});
  const auto part = std::find_if(mesh.parts.begin(), mesh.parts.end(), [](const MeshPart& p) { return p.name == "right"; });
  ASSERT_NE(part, mesh.parts.end());
  ASSERT_EQ(part->triangles.size(), 1u);
  EXPECT_EQ(part->triangles[0][2], Vector3d(0, 1, 0));
}

/// A glTF whose vertices lie in another file: `count` of them are said to be there, in `bytes` of it.
std::string gltf(const std::string& buffer, std::size_t bytes, std::size_t count) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":)" +
         std::to_string(count) + R"(,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}],"bufferViews":[{"buffer":0,"byteLength":)" +
         std::to_string(bytes) + R"(}],"buffers":[{"uri":")" + buffer + R"(","byteLength":)" + std::to_string(bytes) + "}]}";
}

TEST_F(MeshReader, RefusesAGltfWhoseNumbersDoNotFit) {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  write("few.bin", bytes);
  EXPECT_EQ(read(source(write("sound.gltf", gltf("few.bin", bytes.size(), 3)))).triangles.size(), 1u);
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"count.gltf", gltf("few.bin", bytes.size(), 4000000000u)},
                                   {"length.gltf", gltf("few.bin", 36000000, 3000000)},
                                   {"missing.gltf", gltf("none.bin", bytes.size(), 3)},
                                   {"device.gltf", gltf("/dev/zero", 3600, 300)}}) {
    const std::string said = error_of([&, text = text, name = name] { read(source(write(name, text))); });
    EXPECT_NE(said.find(name), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST_F(MeshReader, RefusesAFaceOfTooManyCorners) {
  std::string obj, face = "f";
  for (int k = 1; k <= 5000; ++k) {
    obj += "v " + std::to_string(std::cos(k * 0.00125663706)) + " " + std::to_string(std::sin(k * 0.00125663706)) + " 0\n";
    face += " " + std::to_string(k);
  }
  EXPECT_ERROR(read(source(write("t.obj", obj + face + "\n"))), "face 0 has 5000 corners; 4096 at most are allowed");
}

TEST_F(MeshReader, RefusesAPlyThatEndsInItsHeader) {
  EXPECT_ERROR(read(source(write("cut.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"))), "cut.ply");
}

TEST_F(MeshReader, RefusesAStlWithInfiniteVertices) {
  std::ifstream whole(repository_mesh("spheric2_box.stl"), std::ios::binary);
  std::stringstream bytes;
  bytes << whole.rdbuf();
  std::string text = bytes.str();
  const char infinity[4] = {0, 0, static_cast<char>(0x80), 0x7f};
  text.replace(84 + 12, 4, infinity, 4);
  EXPECT_ERROR(read(source(write("infinite.stl", text))), "infinite.stl");
}

TEST_F(MeshReader, RefusesAScaleThatOverflows) {
  MeshSource from = source(repository_mesh("spheric2_box.stl"));
  from.scale = Vector3d::Constant(std::numeric_limits<double>::infinity());
  EXPECT_ERROR(read(from), "not finite");
}

TEST_F(MeshReader, CommittedMeshesAreTheScripts) {
  const std::string python = std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  const std::string command = python + " '" + WAVETANK_SOURCE_DIRECTORY + "/scripts/make_meshes.py' '" + directory.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  for (const char* name : {"spheric2_tank.stl", "spheric2_box.stl", "cylinder_tank.stl", "sphere.stl", "l_tank.stl"}) {
    std::stringstream made, committed;
    made << std::ifstream(directory / name, std::ios::binary).rdbuf();
    committed << std::ifstream(repository_mesh(name), std::ios::binary).rdbuf();
    EXPECT_GT(made.str().size(), 84u) << name;
    EXPECT_TRUE(made.str() == committed.str()) << name << " differs from what scripts/make_meshes.py writes";
  }
}

}  // namespace
}  // namespace wavetank::mesh_reader_test
