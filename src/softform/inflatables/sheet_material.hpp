#pragma once

#include <memory>

#include "softform/materials/tension_field.hpp"

namespace softform {

/// What sheets of a material do in an inflated structure: they wrinkle where they would be compressed (the relaxed
/// energy (6.6)), and pull as the material does at rest. A residual stiffness of kappa residual p L / (kappa h) keeps
/// slack regions definite, for pressure p [Pa], size L [m] and thickness h [m]: a surface tension of 2 residual p L.
/// smoothing: delta of TensionField, for those who need second derivatives of forces.
std::shared_ptr<const TensionField> sheet_material(const Material& material, double thickness, double pressure,
                                                   double size, double residual = 1e-3, double smoothing = 0);

/// The same for designing panels: with a residual of 2e-3, smoothed by delta = 0.05. With a tenth of that, wrinkles are
/// less soft, but seams that slide far may fold a panel's tip until nothing moves any more.
std::shared_ptr<const TensionField> sheet_material_for_design(const Material& material, double thickness,
                                                              double pressure, double size);

}  // namespace softform
