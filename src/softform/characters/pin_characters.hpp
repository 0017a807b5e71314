#pragma once

#include <string>

#include "softform/characters/drawing.hpp"
#include "softform/characters/pin_pipeline.hpp"

namespace softform {

/// What planar characters are cast from: a silicone sheet with parts of a stiff plastic in it.
struct SheetOptions {
  double soft_shear_modulus = 1.6163e5;  ///< of RTV 141 silicone, the fit in datasets/materials/silicone.json [Pa]
  double contrast = 1000;                ///< ratio of the shear moduli
  double thickness = 0.01;               ///< [m]; it scales the forces and nothing else
};

/// A planar sheet of the two materials, on the geometric path (MixturePath).
PlanarSolid make_sheet(const PlanarMesh& mesh, const SheetOptions& options = {});

/// One of the planar characters in datasets/characters as it is designed for the thesis' tables: its body, its poses
/// and the pipeline's options, with the number of actuators of table 5.2.
struct PinCharacter {
  PosedCharacter drawn;
  PlanarSolid body;
  PinPipelineOptions options;
};

/// "tour_eiffel", "palmy_2d" or "worm_eye", with that many triangles. Throws InputError for other names.
PinCharacter make_pin_character(const std::string& name, int triangle_count);

}  // namespace softform
