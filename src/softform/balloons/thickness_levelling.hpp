#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// How much thicker or thinner (n) [m] a liquid coat of rubber becomes at the vertices of a mould while it levels: it
/// flows from ridges into troughs. A thin film of thickness h follows (Schwartz and Weidner 1995, to first order)
///     dh/dt = c Laplacian(2 H - Laplacian h),   c = surface tension h^3 / (3 viscosity),
/// H the mean curvature of the mould, positive where it is convex, since the pressure under the film's surface is
/// surface tension times its curvature. One implicit Euler step of the time t from a uniform coat,
///     (I + l^4 Laplacian^2) dh = l^4 Laplacian(2 H),   l^4 = c t,
/// smooths over the levelling length l and keeps the volume of rubber. Linear in the curvature: the shape of the
/// variation is meaningful also where its size is beyond a film's thickness.
/// Throws InputError where the length [m] is not positive.
Vec levelled_film(const TriangleMesh& mould, double levelling_length);

/// Values on the triangles (m), the means over their vertices (n), shifted and scaled to an area-weighted mean of 0 and
/// variance of 1. Throws InputError where they are constant.
Vec standardized_on_triangles(const TriangleMesh& mesh, ConstVec vertex_values);

}  // namespace softform
