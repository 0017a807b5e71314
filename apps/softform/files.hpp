#pragma once

#include <optional>
#include <string>
#include <vector>

#include "softform/core/report.hpp"
#include "softform/io/csv.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform::cli {

/// Metres per unit of a file's mesh: `size` [m] is the largest distance between two vertices; without it the file's
/// numbers are millimetres, and a message says so.
double metres_per_unit(const TriangleMesh& mesh, const std::string& file, std::optional<double> size);

/// Reads a mesh that can be inflated and brings it to metres, see metres_per_unit(). Throws InputError with every
/// problem found.
TriangleMesh read_closed_mesh(const std::string& file, std::optional<double> size);

/// Throws InputError unless results can be written into `folder`, which need not exist yet and is not created.
void require_writable(const std::string& folder);

/// metrics.csv in `folder`, which is created. Metrics that are not finite were not reached: they are left out.
void write_metrics(const std::string& folder, std::vector<Metric> metrics);

/// trace.csv in `folder`, which is created: the iterations of an optimiser.
void write_trace(const std::string& folder, const Report& report);

/// The local extension ratio of every triangle, the square root of deformed to rest area.
Field stretch_field(const TriangleMesh& deformed, const TriangleMesh& rest);

}  // namespace softform::cli
