#pragma once

#include <array>
#include <filesystem>

#include <vtkLookupTable.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "layout.hpp"

namespace softform::render {

/// The colours of `range`, in 256 steps.
vtkSmartPointer<vtkLookupTable> lookup_table(ColorMap map, const std::array<double, 2>& range);

/// The field in the unit shown, made the surface's active scalars; returns the range to colour.
/// Throws InputError that names `file` where it has no such field.
std::array<double, 2> activate_field(vtkPolyData& surface, const Scalar& scalar, const std::filesystem::path& file);

}  // namespace softform::render
