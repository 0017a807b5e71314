// Reading rubber tests: units, true stress, inflation, and every way in which a file cannot be used.
#include <gtest/gtest.h>

#include "softform/fitting/rubber_test.hpp"
#include "softform/io/text_file.hpp"
#include "support/expect_input_error.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

class ReadRubberTest : public ::testing::Test {
 protected:
  RubberTest read(const std::string& text, TestMode mode = TestMode::Uniaxial)
  {
    write_text(file(), text);
    return read_rubber_test(file(), mode);
  }
  std::filesystem::path file() const { return folder_.path() / "rubber.csv"; }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(ReadRubberTest, UnitsAreThoseOfTheColumnsName)
{
  for (const auto& [unit, factor] : {std::pair("pa", 1.0), {"kpa", 1e3}, {"mpa", 1e6}, {"kgf_cm2", 98066.5}}) {
    const double scale = 1e5 / factor;
    const auto rubber = read(std::string("stretch,nominal_stress_") + unit + "\n1.5," + std::to_string(scale) + "\n2," +
                             std::to_string(2 * scale) + "\n3," + std::to_string(3 * scale) + "\n");
    ASSERT_EQ(rubber.observations.size(), 3u);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(rubber.observations[std::size_t(k)].stress, 1e5 * (k + 1), 1) << unit;
  }
}

TEST_F(ReadRubberTest, TrueStressIsConverted)
{
  const auto rubber = read("stretch,true_stress_kpa\n1,0\n2,400\n4,1600\n", TestMode::Equibiaxial);
  EXPECT_DOUBLE_EQ(rubber.observations[1].stress, 200e3);
  EXPECT_DOUBLE_EQ(rubber.observations[2].stress, 400e3);
}

TEST_F(ReadRubberTest, BiaxialGivesTwoStressesARow)
{
  const auto rubber = read(
      "stretch_1,stretch_2,nominal_stress_1_mpa,nominal_stress_2_mpa\n1.5,1,0.3,0.1\n1.5,1.5,0.4,0.4\n1.5,1.2,0.35,0."
      "2\n",
      TestMode::Biaxial);
  ASSERT_EQ(rubber.observations.size(), 6u);
  EXPECT_EQ(rubber.observations[1].direction, 1);
  EXPECT_DOUBLE_EQ(rubber.observations[1].stress, 0.1e6);
  EXPECT_DOUBLE_EQ(rubber.observations[1].stretches[0], 1.5);
  EXPECT_EQ(rubber.observations[1].line, 2);
}

TEST_F(ReadRubberTest, InflationGivesTheStressAtThePole)
{
  const auto rubber =
      read("# thickness: 0.5 mm\npressure_kpa,pole_radius_cm,stretch\n2,4,1.2\n3,3,1.5\n2,5,2\n", TestMode::Inflation);
  EXPECT_NEAR(rubber.observations[0].stress, 2e3 * 0.04 * 1.2 / (2 * 0.5e-3), 1e-6);
  EXPECT_DOUBLE_EQ(rubber.observations[0].stretches[1], 1.2);
}

TEST_F(ReadRubberTest, CompressionThroughRestIsFine)
{
  EXPECT_EQ(read("stretch,nominal_stress_mpa\n0.6,-0.5\n1,0\n1.5,0.3\n").observations.size(), 3u);
}

TEST_F(ReadRubberTest, TreloarsPrintedTensionIsReproduced)
{
  // Table I prints the tension t in kg per cm of width and cm of thickness: nominal stress t L g/cm^2.
  const auto sheet = load_rubber_test("treloar_1944_sheet_inflation");
  const std::vector<double> printed{0.92, 1.5,  2.17, 2.3,  2.77, 3.38, 3.65, 3.93,
                                    4.01, 3.93, 4.17, 4.28, 4.64, 4.94, 5.27, 5.54};
  ASSERT_EQ(sheet.observations.size(), printed.size());
  for (std::size_t k = 0; k < printed.size(); ++k) {
    const auto& [stretches, direction, stress, line] = sheet.observations[k];
    EXPECT_NEAR(stress / stretches[0] / 98066.5 / printed[k], 1, 0.007) << "line " << line;  // printed to 3 digits
  }
}

TEST_F(ReadRubberTest, EveryPublishedTestIsRead)
{
  const std::map<std::string, std::pair<TestMode, std::size_t>> published{
      {"treloar_1944_uniaxial", {TestMode::Uniaxial, 25}},
      {"treloar_1944_pure_shear", {TestMode::PureShear, 14}},
      {"treloar_1944_sheet_inflation", {TestMode::Inflation, 16}},
      {"treloar_1944_latex_equibiaxial", {TestMode::Equibiaxial, 19}},
      {"meunier_2008_silicone_uniaxial", {TestMode::Uniaxial, 33}},
      {"meunier_2008_silicone_equibiaxial", {TestMode::Equibiaxial, 14}},
  };
  for (const auto& [name, expected] : published) {
    const auto rubber = load_rubber_test(name);
    EXPECT_EQ(rubber.mode, expected.first) << name;
    EXPECT_EQ(rubber.observations.size(), expected.second) << name;
    EXPECT_FALSE(rubber.citation.empty()) << name;
  }
}

TEST_F(ReadRubberTest, AByteOrderMarkIsNoPartOfTheFirstColumn)
{
  EXPECT_EQ(read("\xEF\xBB\xBFstretch,nominal_stress_mpa\n1,0\n2,0.5\n3,1\n").observations.size(), 3u);
}

TEST_F(ReadRubberTest, AnOffsetAtRestOfAFewPercentIsFine)
{
  EXPECT_EQ(read("stretch,nominal_stress_mpa\n1,0.02\n2,0.5\n3,1\n").observations.size(), 3u);
}

struct BadFile {
  const char* what;
  const char* text;
  std::vector<std::string> words;  ///< of the message: the line, the thing, the cure
  TestMode mode = TestMode::Uniaxial;
};

const std::vector<BadFile> bad_files{
    {"empty", "", {"empty", "stretch,nominal_stress_mpa"}},
    {"comments alone", "# mode: uniaxial\n", {"empty"}},
    {"too few points", "stretch,nominal_stress_mpa\n1,0\n2,0.5\n", {"2 points", "at least 3"}},
    {"stretch of zero", "stretch,nominal_stress_mpa\n0,0\n1,0.1\n2,0.2\n", {"line 2", "stretch of 0", "1 + strain"}},
    {"negative stretch", "stretch,nominal_stress_mpa\n-1,-1\n1,0\n2,0.2\n", {"line 2", "-1"}},
    {"percentage", "stretch,nominal_stress_mpa\n10,0.1\n100,0.2\n200,0.4\n", {"line 3", "100", "percentage"}},
    {"decreasing",
     "stretch,nominal_stress_mpa\n1,0\n2,0.5\n1.5,0.4\n",
     {"line 4", "decreases from 2 to 1.5", "sorted"}},
    {"repeated", "stretch,nominal_stress_mpa\n1,0\n2,0.5\n2,0.5\n", {"line 4", "twice", "average"}},
    {"NaN", "stretch,nominal_stress_mpa\n1,0\n2,nan\n3,1\n", {"line 3", "nan", "finite"}},
    {"infinite", "stretch,nominal_stress_mpa\n1,0\n2,inf\n3,1\n", {"line 3", "inf", "finite"}},
    {"a word", "stretch,nominal_stress_mpa\n1,0\n2,much\n3,1\n", {"line 3", "'much'", "not a number"}},
    {"a missing value", "stretch,nominal_stress_mpa\n1,0\n2,\n3,1\n", {"line 3", "not a number"}},
    {"a value too many", "stretch,nominal_stress_mpa\n1,0\n2,0.5,7\n3,1\n", {"line 3", "3 values", "2 columns"}},
    {"no header", "1,0\n2,0.5\n3,1\n", {"line 1", "'stretch' is missing"}},
    {"wrong column", "strain,nominal_stress_mpa\n0,0\n1,0.5\n2,1\n", {"line 1", "'stretch'", "strain"}},
    {"no unit", "stretch,nominal_stress\n1,0\n2,0.5\n3,1\n", {"line 1", "nominal_stress_mpa"}},
    {"unknown unit", "stretch,nominal_stress_psi\n1,0\n2,5\n3,10\n", {"line 1", "nominal_stress_psi", "_kpa"}},
    {"just stress", "stretch,stress_mpa\n1,0\n2,0.5\n3,1\n", {"line 1", "stress_mpa", "true_stress"}},
    {"two units",
     "stretch,nominal_stress_mpa,nominal_stress_kpa\n1,0,0\n2,1,1\n3,2,2\n",
     {"line 1", "twice", "keep one"}},
    {"nominal and true", "stretch,nominal_stress_mpa,true_stress_mpa\n1,0,0\n2,1,2\n3,2,6\n", {"line 1", "keep one"}},
    {"unknown column", "stretch,nominal_stress_mpa,colour\n1,0,1\n2,1,1\n3,2,1\n", {"line 1", "'colour'", "remove"}},
    {"a column twice",
     "stretch,nominal_stress_mpa,stretch\n1,0,1\n2,1,2\n3,2,3\n",
     {"line 1", "'stretch'", "keep one"}},
    {"stress at rest", "stretch,nominal_stress_mpa\n1,0.4\n2,0.5\n3,1\n", {"line 2", "at rest", "offset"}},
    {"wrong sign", "stretch,nominal_stress_mpa\n1,0\n2,-0.5\n3,1\n", {"line 3", "wrong sign", "tension is positive"}},
    {"unit off by a million",
     "stretch,nominal_stress_mpa\n1,0\n2,500000\n3,900000\n",
     {"line 4", "implausible", "unit"}},
    {"unit off the other way", "stretch,nominal_stress_pa\n1,0\n2,0.5\n3,0.9\n", {"line 4", "implausible", "unit"}},
    {"another mode", "# mode: pure_shear\nstretch,nominal_stress_mpa\n1,0\n2,0.5\n3,1\n", {"pure_shear", "uniaxial"}},
    {"an unknown mode", "# mode: twisting\nstretch,nominal_stress_mpa\n1,0\n2,0.5\n3,1\n", {"twisting", "uniaxial"}},
    {"uniaxial columns", "stretch,nominal_stress_mpa\n1,0\n2,0.5\n3,1\n", {"'stretch_1'"}, TestMode::Biaxial},
    {"mixed units",
     "stretch_1,stretch_2,nominal_stress_1_mpa,nominal_stress_2_kpa\n1,1,0,0\n2,1,1,2\n2,2,3,3\n",
     {"line 1", "mix units", "one for both"},
     TestMode::Biaxial},
    {"repeated pair",
     "stretch_1,stretch_2,nominal_stress_1_mpa,nominal_stress_2_mpa\n1,1,0,0\n2,1,1,2\n2,1,3,3\n",
     {"line 4", "twice"},
     TestMode::Biaxial},
    {"no thickness",
     "pressure_kpa,pole_radius_cm,stretch\n2,4,1.2\n3,3,1.5\n2,5,2\n",
     {"thickness", "# thickness: 0.5 mm"},
     TestMode::Inflation},
    {"thickness without unit",
     "# thickness: 0.5\npressure_kpa,pole_radius_cm,stretch\n2,4,1.2\n3,3,1.5\n2,5,2\n",
     {"no unit"},
     TestMode::Inflation},
    {"negative radius",
     "# thickness: 0.5 mm\npressure_kpa,pole_radius_cm,stretch\n2,4,1.2\n3,-3,1.5\n2,5,2\n",
     {"line 4", "positive radius"},
     TestMode::Inflation},
};

TEST_F(ReadRubberTest, RefusesWhatCannotBeUsed)
{
  for (const BadFile& bad : bad_files) {
    SCOPED_TRACE(bad.what);
    std::vector<std::string> words = bad.words;
    words.push_back("rubber.csv");
    test::expect_input_error([&] { read(bad.text, bad.mode); }, words);
  }
  test::expect_input_error([] { read_rubber_test("missing.csv", TestMode::Uniaxial); }, {"missing.csv", "check"});
}

}  // namespace
}  // namespace softform
