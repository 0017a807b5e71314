#include "softform/io/vtk_io.hpp"

#include <sstream>

#include <gtest/gtest.h>

#include "support/expect_input_error.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

TEST(Vtp, keeps_mesh_and_fields)
{
  const test::TemporaryFolder folder;
  const TriangleMesh mesh = test::tetrahedron();
  const Eigen::MatrixXd distance = Eigen::VectorXd::LinSpaced(4, 0.1, 0.7);
  const Eigen::MatrixXd normals = Eigen::MatrixXd::Random(4, 3);
  write_vtp(folder / "out/a.vtp", mesh, {{{"distance [m]", distance}}, {{"normal", normals}}});
  const SurfaceWithFields back = read_vtp(folder / "out/a.vtp");

  EXPECT_EQ(back.mesh.vertices, mesh.vertices);
  EXPECT_EQ(back.mesh.triangles, mesh.triangles);
  EXPECT_EQ(back.fields.at("distance [m]"), distance);
  EXPECT_EQ(back.fields.at("normal"), normals);
  ASSERT_EQ(back.fields.on_vertices.size(), 1u);
  ASSERT_EQ(back.fields.on_triangles.size(), 1u);
  test::expect_input_error([&] { back.fields.at("stretch"); }, {"'stretch'", "distance [m], normal"});
}

TEST(Vtp, refuses_what_is_no_surface)
{
  const test::TemporaryFolder folder;
  test::expect_input_error([&] { read_vtp(folder / "none.vtp"); }, {"none.vtp", "no such file"});
  test::expect_input_error([&] { read_vtp(folder.write("a.vtp", "hello")); }, {"a.vtp", "no complete VTK surface"});
}

TEST(Pvd, names_its_files_from_its_own_folder)
{
  const test::TemporaryFolder folder;
  write_pvd(folder / "series.pvd", {{0.5, "a.vtp"}, {1.0, folder / "steps/b.vtp"}});
  std::ifstream file(folder / "series.pvd");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find("timestep=\"0.5\" file=\"a.vtp\""), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("timestep=\"1\" file=\"steps/b.vtp\""), std::string::npos) << text.str();
}

}  // namespace
}  // namespace softform
