#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace softform {

/// How a rubber was stretched, homogeneously. Inflation is that of a clamped sheet, seen at its pole: equibiaxial.
enum class TestMode { Uniaxial, Equibiaxial, PureShear, Biaxial, Inflation };

/// "uniaxial", "equibiaxial", "pure_shear", "biaxial", "inflation".
const char* to_string(TestMode mode);

/// The in-plane principal stretches of an incompressible sheet in plane stress; the third is 1/(l_1 l_2).
using Stretches = Eigen::Array2d;

/// Both stretches of a test with one degree of freedom at the stretch measured: (l, l^-1/2), (l, l) or (l, 1).
/// Precondition: mode is not Biaxial.
Stretches stretches_of(TestMode mode, double stretch);

/// One measured number: the nominal stress [Pa] in a direction (0 or 1) at these stretches.
struct StressObservation {
  Stretches stretches;
  int direction = 0;
  double stress = 0;
  int line = 0;  ///< of the file
};

/// A test as it was measured, in SI units.
struct RubberTest {
  TestMode mode = TestMode::Uniaxial;
  std::string name;      ///< the file's name
  std::string citation;  ///< empty where the file gives none
  std::vector<StressObservation> observations;

  double largest_stress() const;  ///< [Pa], of the absolute values
};

/// Reads a test in the format of datasets/rubber/README.md. True stress and sheet inflation become nominal stress.
/// Throws InputError naming the file, the line and the cure: an unknown column or unit, mixed units, a number that is
/// none, a column that comes twice, a stretch that is not positive, decreases or repeats, a stress of the wrong sign,
/// of implausible size or at rest, fewer than 3 points, or a file whose header says that it is of another mode.
RubberTest read_rubber_test(const std::filesystem::path& file, TestMode mode);

/// The same for a published test of datasets/rubber by its name, with the mode that its header says.
RubberTest load_rubber_test(const std::string& name);

}  // namespace softform
