#include "softform/characters/pin_characters.hpp"

#include <map>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/materials/registry.hpp"

namespace softform {

PlanarSolid make_sheet(const PlanarMesh& mesh, const SheetOptions& options)
{
  const auto rubber = [](double mu) { return plane_stress(make_material("neo_hookean", {{"mu", mu}})); };
  const Mixture mixture(rubber(options.soft_shear_modulus), rubber(options.contrast * options.soft_shear_modulus),
                        MixturePath::Geometric);
  SolidOptions<2> solid;
  solid.thickness = options.thickness;
  return PlanarSolid(mesh.elements, mesh.positions, mixture, solid);
}

PinCharacter make_pin_character(const std::string& name, int triangle_count)
{
  static const std::map<std::string, int> actuators{{"tour_eiffel", 5}, {"palmy_2d", 4}, {"worm_eye", 8}};
  const auto count = actuators.find(name);
  if (count == actuators.end())
    throw InputError(fmt::format("'{}' is no planar character: tour_eiffel, palmy_2d and worm_eye are", name));
  PosedCharacter drawn = make_character(load_drawing(name), triangle_count);
  PlanarSolid body = make_sheet(drawn.rest);
  PinPipelineOptions options;
  options.actuators = {count->second, count->second};
  options.held = drawn.held;
  options.way = drawn.way;
  options.first_density = 0.3;
  // Few large parts that are decided early: where the layout stays grey for long, pins and hinges agree on poses at the
  // brink of buckling, which no crisp layout continues.
  options.layout.weights.crisp = 0.2;
  options.layout.weights.smooth = 0.5;
  options.layout.weights.soft = 1e-2;
  // Their largest distances are small beside the mean ones already.
  options.layout.largest_weight = 0;
  options.layout.largest_flips = 200;
  return {std::move(drawn), std::move(body), std::move(options)};
}

}  // namespace softform
