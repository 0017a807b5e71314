#include "softform/io/datasets.hpp"

#include <cmath>
#include <cstdlib>
#include <map>

#include <gtest/gtest.h>

#include "softform/io/mesh_io.hpp"
#include "softform/io/sha256.hpp"
#include "support/expect_input_error.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

TEST(Manifest, states_origin_licence_and_the_counts_of_table_4_1)
{
  std::map<std::string, int> vertices;
  for (const Dataset& dataset : read_manifest(default_manifest())) {
    vertices[dataset.id] = dataset.vertices.front();
    EXPECT_TRUE(!dataset.model || std::filesystem::exists(*dataset.model)) << dataset.id;
    EXPECT_FALSE(dataset.licence.empty()) << dataset.id;
    EXPECT_FALSE(dataset.credit.empty()) << dataset.id;
    EXPECT_FALSE(dataset.unit.empty()) << dataset.id;
    EXPECT_EQ(dataset.origin ? dataset.origin->sha256.size() : 64u, 64u) << dataset.id;
  }
  EXPECT_EQ(vertices.at("bunny"), 4975);
  EXPECT_EQ(vertices.at("armadillo"), 6027);
  EXPECT_EQ(vertices.at("teddy"), 3527);
  EXPECT_EQ(vertices.at("elephant"), 3818);
  EXPECT_EQ(vertices.at("hand"), 2253);
  EXPECT_EQ(vertices.at("gingerbread"), 2238);
  EXPECT_EQ(vertices.at("mouse"), 2633);
  EXPECT_EQ(vertices.at("squirrel"), 5995);
  EXPECT_EQ(vertices.at("cube"), 5153);
  EXPECT_EQ(vertices.at("bumpsphere"), 3265);
}

TEST(Manifest, refuses_unknown_keys)
{
  const test::TemporaryFolder folder;
  const auto path = folder.write("m.json", R"({"datasets": [{"id": "a", "vertices": [10], "unit": "m", "credit": "us",
    "licence": "MIT", "colour": "red"}]})");
  test::expect_input_error([&] { read_manifest(path); }, {"m.json", "colour"});
  test::expect_input_error([&] { read_manifest(folder / "none.json"); }, {"none.json", "no such file"});
  test::expect_input_error([&] { read_manifest(folder.write("bad.json", "{")); }, {"bad.json"});
}

class LoadDataset : public ::testing::Test {
 protected:
  LoadDataset() { setenv("SOFTFORM_CACHE", folder.path().c_str(), 1); }
  ~LoadDataset() override { unsetenv("SOFTFORM_CACHE"); }
  test::TemporaryFolder folder;
};

TEST_F(LoadDataset, reads_the_cache_first)
{
  write_mesh(folder / "bunny_4.off", test::tetrahedron());
  EXPECT_EQ(load_dataset("bunny", 4).vertices, test::tetrahedron().vertices);
}

TEST_F(LoadDataset, makes_exact_shapes_that_are_not_there)
{
  EXPECT_EQ(load_dataset("sphere", 150).vertex_count(), 150);
}

TEST_F(LoadDataset, says_how_to_prepare_what_is_not_there)
{
  test::expect_input_error([] { load_dataset("bunny", 4975); }, {"softform-datasets prepare bunny", "4975, 1200"});
  test::expect_input_error([] { load_dataset("rabbit", 4975); }, {"no dataset 'rabbit'", "bunny, armadillo"});
}

TEST(Sha256, of_known_text)
{
  const test::TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.write("abc", "abc")),  // FIPS 180-2, appendix B.1
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  test::expect_input_error([&] { sha256_of_file(folder / "none"); }, {"none", "cannot be read"});
}

TEST(ScaleToDiameter, measures_between_vertices)
{
  const TriangleMesh mesh = scale_to_diameter(test::tetrahedron(), 0.146);
  EXPECT_NEAR(diameter(mesh.vertices), 0.146, 1e-15);
  EXPECT_NEAR(mesh.vertices(1, 0), 0.146 / std::sqrt(2.0), 1e-15);
}

}  // namespace
}  // namespace softform
