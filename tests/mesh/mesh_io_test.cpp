#include "softform/io/mesh_io.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "softform/mesh/check.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

class RoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, keeps_the_surface)
{
  const test::TemporaryFolder folder;
  const auto path = folder / (std::string("mesh") + GetParam());
  const TriangleMesh mesh = irregular_sphere(0.073, 150);
  write_mesh(path, mesh);
  const TriangleMesh back = read_mesh(path);

  ASSERT_EQ(back.vertex_count(), mesh.vertex_count());
  ASSERT_EQ(back.triangle_count(), mesh.triangle_count());
  EXPECT_TRUE(check_mesh(back).usable());
  // STL has single precision and no vertex order; the others are exact.
  if (std::string(GetParam()) == ".stl" || std::string(GetParam()) == ".STL") {
    EXPECT_NEAR(enclosed_volume(back), enclosed_volume(mesh), 1e-6 * enclosed_volume(mesh));
  } else {
    EXPECT_EQ(back.vertices, mesh.vertices);
    EXPECT_EQ(back.triangles, mesh.triangles);
  }
  // Nothing but the file itself stays behind.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, ::testing::Values(".off", ".obj", ".ply", ".stl", ".STL"));

TEST(ReadMesh, merges_the_corners_of_ascii_stl)
{
  const test::TemporaryFolder folder;
  const TriangleMesh tetrahedron = test::tetrahedron();
  std::ofstream file(folder / "t.stl");
  file << "solid t\n";
  for (int t = 0; t < 4; ++t) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) file << "vertex " << tetrahedron.vertices.row(tetrahedron.triangles(t, k)) << "\n";
    file << "endloop\nendfacet\n";
  }
  file << "endsolid t\n";
  file.close();
  const TriangleMesh mesh = read_mesh(folder / "t.stl");
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_TRUE(check_mesh(mesh).usable());
}

TEST(ReadMesh, splits_quadrangles_along_the_shorter_diagonal)
{
  const test::TemporaryFolder folder;
  const TriangleMesh mesh =
      read_mesh(folder.write("q.obj", "v -2 0 0\nv 0 -1 0\nv 2 0 0\nv 0 1 0\nf 1/1/1 2/2/2 3/3/3 4/4/4\n"));
  ASSERT_EQ(mesh.triangle_count(), 2);
  const auto edges = edges_of(mesh.triangles, 4);
  const auto inner = std::find_if(edges.begin(), edges.end(), [](const Edge& edge) { return edge.right >= 0; });
  ASSERT_NE(inner, edges.end());
  EXPECT_EQ(std::minmax(inner->start, inner->end), std::minmax(1, 3));
}

TEST(ReadMesh, reads_relative_indices_of_obj)
{
  const test::TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("r.obj", "# c\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"));
  EXPECT_EQ(mesh.triangles, (Triangles(1, 3) << 0, 1, 2).finished());
}

struct BadFile {
  const char* name;
  const char* file;
  const char* text;  ///< nullptr: no such file
  std::vector<std::string> message;
};

class BadMeshFile : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadMeshFile, is_refused_by_name)
{
  const test::TemporaryFolder folder;
  const auto& bad = GetParam();
  const auto path = bad.text == nullptr ? folder / bad.file : folder.write(bad.file, bad.text);
  auto message = bad.message;
  message.push_back(path.string());
  test::expect_input_error([&] { read_mesh(path); }, message);
}

const BadFile bad_files[] = {
    {"missing", "a.off", nullptr, {"no such file", "check the path"}},
    {"empty", "a.off", "", {"empty", "export"}},
    {"unknown_format", "a.xyz", "0 0 0\n", {".xyz", "use .off, .obj, .ply or .stl"}},
    {"no_extension", "a", "OFF\n", {"use .off, .obj, .ply or .stl"}},
    {"garbage_off", "a.off", "hello world\nthis is no mesh\n", {"no complete off file", "repair"}},
    {"garbage_obj", "a.obj", "hello world\n", {"no complete obj file"}},
    {"garbage_ply", "a.ply", "hello world\n", {"no complete ply file"}},
    {"garbage_stl", "a.stl", "hello world\n", {"no complete stl file"}},
    {"cut_off", "a.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n", {"no complete off file"}},
    {"no_faces", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", {"no complete obj file", "faces"}},
    {"nan_off", "a.off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", {"line 4", "not finite"}},
    {"inf_obj", "a.obj", "v 0 0 0\nv 1 -inf 0\nv 0 1 0\nf 1 2 3\n", {"line 2", "not finite"}},
    {"nan_ply",
     "a.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 NaN 0\n0 1 0\n3 0 1 2\n",
     {"line 11", "not finite"}},
    {"nan_stl",
     "a.stl",
     "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex nan 0 0\nvertex 0 1 "
     "0\nendloop\nendfacet\nendsolid\n",
     {"line 5", "not finite"}},
    {"index_off", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", {"repair"}},
    {"index_obj", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", {"face 0", "vertex 3", "of only 3"}},
    {"negative_obj", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", {"repair"}},
    {"pentagon", "a.off", "OFF\n5 1 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n", {"face 0", "5 corners"}},
};
INSTANTIATE_TEST_SUITE_P(All, BadMeshFile, ::testing::ValuesIn(bad_files),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(ReadMesh, refuses_a_nan_in_a_binary_file)
{
  const test::TemporaryFolder folder;
  TriangleMesh mesh = test::tetrahedron();
  mesh.vertices(2, 1) = std::nan("");
  write_mesh(folder / "a.ply", mesh);
  test::expect_input_error([&] { read_mesh(folder / "a.ply"); }, {"vertex 2", "not finite"});
}

TEST(WriteMesh, says_when_it_cannot_write)
{
  const test::TemporaryFolder folder;
  folder.write("file", "no folder");
  test::expect_input_error([&] { write_mesh(folder / "file/a.off", test::tetrahedron()); }, {"a.off", "writable"});
}

}  // namespace
}  // namespace softform
