#pragma once

#include <memory>

#include "softform/inflatables/pattern_design.hpp"

namespace softform {

/// What sheets of a material do in an inflated structure: they wrinkle where they would be compressed (TensionField,
/// the relaxed energy (6.6)), and pull as the material does at rest. A residual stiffness of kappa residual p L /
/// (kappa h) keeps slack regions definite, for pressure p [Pa], size L [m] and thickness h [m]: a surface tension of 2
/// residual p L.
std::shared_ptr<const Material> sheet_material(const Material& material, double thickness, double pressure, double size,
                                               double residual = 1e-3);

/// Sheets to be inflated, of a sheet_material.
InflationSettings sheet_inflation(const Material& material, double thickness, double pressure, double size);

/// The same for designing panels: of materials whose wrinkles come and go gradually (BarrierTensionField), first over
/// half the strain to which the pressure stretches a sphere of the size, in the end over a quarter. The residual is
/// 3e-3.
InflationSettings design_inflation(const Material& material, double thickness, double pressure, double size);

}  // namespace softform
