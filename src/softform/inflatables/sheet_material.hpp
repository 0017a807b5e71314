#pragma once

#include <memory>

#include "softform/materials/tension_field.hpp"

namespace softform {

/// What sheets of a material do in an inflated structure: they wrinkle where they would be compressed (the relaxed
/// energy (6.6)), and pull as the material does at rest. A residual stiffness of kappa residual p L / (kappa h) keeps
/// slack regions definite, for pressure p [Pa], size L [m] and thickness h [m]: a surface tension of 2 residual p L.
std::shared_ptr<const TensionField> sheet_material(const Material& material, double thickness, double pressure,
                                                   double size, double residual = 1e-3);

}  // namespace softform
