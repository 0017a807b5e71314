#include "softform/materials/material_file.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "softform/core/error.hpp"
#include "softform/materials/registry.hpp"
#include "support/materials.hpp"

namespace softform {
namespace {

namespace fs = std::filesystem;

class MaterialFile : public ::testing::Test {
 protected:
  void SetUp() override
  {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    file_ = fs::temp_directory_path() / (std::string("softform_") + test->name() + ".json");
  }
  void TearDown() override { fs::remove(file_); }

  std::string refusal(const std::string& text) const
  {
    std::ofstream(file_) << text;
    try {
      read_material(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path file_;
};

TEST_F(MaterialFile, WritesWhatItReads)
{
  for (const std::string& model : testing::model_names()) {
    const auto material = testing::example_of(model);
    write_material(file_, *material, "test");
    const auto copy = read_material(file_);
    EXPECT_EQ(copy->model(), material->model());
    EXPECT_EQ(testing::energy(*copy, 1.9, 1.1), testing::energy(*material, 1.9, 1.1));
  }
}

TEST_F(MaterialFile, RefusesWithTheFileAndTheCause)
{
  const std::string head = R"({"model": "hart_smith", "source": "test", "parameters": )";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"{\"model\": \"hart_smith\",\n \"parameters\": }", "line 2"},
      {"", "not valid JSON"},
      {"[1, 2]", "must hold an object"},
      {R"({"parameters": {}, "source": "test"})", "'model' is missing"},
      {R"({"model": "hart_smith", "parameters": {}})", "'source' is missing"},
      {R"({"model": "jelly", "parameters": {}, "source": "test"})", "unknown material model 'jelly'"},
      {R"({"model": 3, "parameters": {}, "source": "test"})", "'model' must be string"},
      {R"({"model": "neo_hookean", "parameters": {"mu": "1 MPa"}, "source": "test", "colour": "red"})", "'colour'"},
      {head + R"({"G": 161630, "k1": 0.02, "k2": 0.2}})", "G = 161630 has no unit"},
      {head + R"({"G": "161630", "k1": 0.02, "k2": 0.2}})", "no unit"},
      {head + R"({"G": "1 mm", "k1": 0.02, "k2": 0.2}})", "'mm'"},
      {head + R"({"G": "1 MPa", "k1": "0.02 Pa", "k2": 0.2}})", "k1 = \"0.02 Pa\" must be a plain number"},
      {head + R"({"G": "1 MPa", "k1": 0.02}})", "'k2' is missing"},
      {head + R"({"G": "1 MPa", "k1": 0.02, "k2": 0.2, "k3": 1}})", "'k3'"},
      {head + R"({"G": "1 MPa", "k1": -0.02, "k2": 0.2}})", "k1 = -0.02 is negative"},
      {head + R"({"G": "1 MPa", "k1": 0.02, "k2": -0.2}})", "k2 = -0.2 is negative"},
      {head + R"({"G": "-1 MPa", "k1": 0.02, "k2": 0.2}})", "G = -1e+06 Pa"},
      {R"({"model": "ogden", "parameters": {"mu_1": "1 Pa", "alpha_1": 0}, "source": "test"})", "alpha_1 is zero"},
      {R"({"model": "ogden", "parameters": {"mu_1": "-1 Pa", "alpha_1": 2}, "source": "test"})", "positive"},
      {R"({"model": "ogden", "parameters": {"mu_1": "1 Pa", "alpha_1": 2, "mu_2": "1 Pa"}, "source": "test"})",
       "alpha_2"},
      {R"({"model": "ogden", "parameters": {}, "source": "test"})", "mu_1"},
      {R"({"model": "neo_hookean", "parameters": {"mu": "0 Pa"}, "source": "test"})", "positive"},
      {R"({"model": "mooney_rivlin", "parameters": {"mu_1": "1 Pa", "mu_2": "-0.1 Pa"}, "source": "t"})", "mu_2"},
      {R"({"model": "mooney_rivlin", "parameters": {"mu_1": "0 Pa", "mu_2": "0 Pa"}, "source": "t"})", "positive"},
      {R"({"model": "st_venant_kirchhoff", "parameters": {"mu": "-1 Pa", "lambda": "0 Pa"}, "source": "t"})", "mu"},
      {R"({"model": "st_venant_kirchhoff", "parameters": {"mu": "1 Pa", "lambda": "-1 Pa"}, "source": "t"})", "lambda"},
  };
  for (const auto& [text, cause] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(file_.string()), std::string::npos) << text << "\n" << message;
    EXPECT_NE(message.find(cause), std::string::npos) << text << "\n" << message;
  }
}

TEST_F(MaterialFile, LoadsEveryMaterialThatShips)
{
  for (const char* name : {"silicone", "latex", "treloar_equibiaxial", "ogden_1972", "neo_hookean", "mooney_rivlin",
                           "st_venant_kirchhoff"})
    EXPECT_GT(load_material(name)->shear_modulus(), 1e5) << name;
}

TEST_F(MaterialFile, OgdensPublishedSetKeepsItsShearModulus)
{
  // Ogden 1972: the shear modulus is sum mu alpha / 2 in his convention.
  EXPECT_NEAR(load_material("ogden_1972")->shear_modulus(), 0.5e6 * (0.6178 * 1.3 + 0.001177 * 5 + 0.009807 * 2), 1);
}

TEST_F(MaterialFile, ListsTheKnownNamesForAnUnknownOne)
{
  try {
    load_material("unobtainium");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("latex"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace softform
