// A neo-Hookean cantilever on the same tetrahedra by CalculiX, an independent finite-element code. Skipped where the
// program `ccx` (Debian: calculix-ccx) is not installed.

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "softform/equilibrium/loaded_solid.hpp"
#include "support/temporary_folder.hpp"

namespace softform::testing {
namespace {

const Eigen::Vector3d size(0.08, 0.01, 0.01);  // [m]
constexpr double G = 1e5, kappa = 4e5;         // [Pa]
constexpr double tip_load = -0.15;             // [N] in z

bool is_clamped(const Eigen::Vector3d& X) { return X.x() < 1e-9; }
bool is_loaded(const Eigen::Vector3d& X) { return X.x() > size.x() - 1e-9; }

Eigen::Vector3d vertex_of(const SimplexMesh<3>& mesh, int i) { return mesh.positions.segment<3>(3 * i); }

// CalculiX' neo-Hooke is (A.4): C10 = G/2, D1 = 2/kappa. Its default tolerance is half a percent: tightened.
void write_input(const std::filesystem::path& path, const SimplexMesh<3>& mesh, double nodal_load)
{
  std::ofstream file(path);
  file << "*NODE, NSET=ALL\n";
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Eigen::Vector3d X = vertex_of(mesh, i);
    file << fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", i + 1, X.x(), X.y(), X.z());
  }
  file << "*ELEMENT, TYPE=C3D4, ELSET=BODY\n";
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto corners = mesh.elements.row(e);
    file << fmt::format("{}, {}, {}, {}, {}\n", e + 1, corners[0] + 1, corners[1] + 1, corners[2] + 1, corners[3] + 1);
  }
  file << fmt::format("*MATERIAL, NAME=RUBBER\n*HYPERELASTIC, NEO HOOKE\n{:.15g}, {:.15g}\n", G / 2, 2 / kappa);
  file << "*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER\n*BOUNDARY\n";
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (is_clamped(vertex_of(mesh, i))) file << i + 1 << ", 1, 3\n";
  file << "*STEP, NLGEOM, INC=1000\n*STATIC\n0.2, 1\n*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-8, , , , 1e-8\n*CLOAD\n";
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (is_loaded(vertex_of(mesh, i))) file << fmt::format("{}, 3, {:.15g}\n", i + 1, nodal_load);
  file << "*NODE PRINT, NSET=ALL, FREQUENCY=1000\nU\n*END STEP\n";
}

// The displacements of the last table of a .dat file.
Vec read_displacements(const std::filesystem::path& path, int vertex_count)
{
  Vec u = Vec::Constant(3 * vertex_count, std::nan(""));
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    int node = 0;
    Eigen::Vector3d d;
    if (words >> node >> d.x() >> d.y() >> d.z()) u.segment<3>(3 * (node - 1)) = d;
  }
  return u;
}

TEST(CalculiX, FindsTheSameCantilever)
{
  ASSERT_EQ(std::system("command -v ccx > /dev/null 2>&1"), 0) << "CalculiX is missing: apt-get install calculix-ccx";
  const SimplexMesh<3> mesh = grid<3>(size, {16, 2, 2});
  int loaded = 0;
  for (int i = 0; i < mesh.vertex_count(); ++i) loaded += is_loaded(vertex_of(mesh, i));
  const test::TemporaryFolder folder;
  write_input(folder / "beam.inp", mesh, tip_load / loaded);
  const std::string run = fmt::format("cd {} && OMP_NUM_THREADS=1 ccx beam > log.txt 2>&1", folder.path().string());
  ASSERT_EQ(std::system(run.c_str()), 0);
  const Vec theirs = read_displacements(folder / "beam.dat", mesh.vertex_count());
  ASSERT_TRUE(theirs.allFinite());

  const Solid<3> body(mesh.elements, mesh.positions, Mixture(neo_hookean_solid(G, kappa, NeoHookeanForm::Isochoric)));
  FixedDofs clamp{Vec::Ones(mesh.positions.size())};
  Vec loads = Vec::Zero(mesh.positions.size());
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    if (is_clamped(vertex_of(mesh, i))) clamp.free.segment<3>(3 * i).setZero();
    if (is_loaded(vertex_of(mesh, i))) loads[3 * i + 2] = tip_load / loaded;
  }
  SparseFactorization factorization;
  const LoadedSolid<3> potential(body, Vec::Zero(body.element_count()), loads);
  const Equilibrium ours = solve_equilibrium(potential, mesh.positions, factorization, {}, clamp);
  ASSERT_TRUE(ours.report.converged()) << ours.report.message;
  const Vec u = ours.x - mesh.positions;
  // A large deflection, and both codes in it.
  EXPECT_GT(u.lpNorm<Eigen::Infinity>(), 0.3 * size.x());
  EXPECT_LT((u - theirs).lpNorm<Eigen::Infinity>(), 1e-4 * u.lpNorm<Eigen::Infinity>());
}

}  // namespace
}  // namespace softform::testing
