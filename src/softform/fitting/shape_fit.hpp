#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "softform/fitting/membrane_test.hpp"
#include "softform/fitting/membrane_test_campaign.hpp"
#include "softform/mesh/rbf_implicit.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// One scanned sheet: a pressure-shape pair of (4.9).
struct ShapeObservation {
  double thickness = 0;  ///< [m]
  double pressure = 0;   ///< [Pa]
  std::shared_ptr<const RbfImplicit> surface;
};

/// All that was observed at one volume [m^3].
struct ShapeStep {
  double volume = 0;
  std::vector<ShapeObservation> observations;
};

/// What is prescribed in a simulated step, the measured volume or the measured pressure.
enum class Control { Volume, Pressure };

/// The fit of a material to scans of inflated sheets by their shape (4.9), all pressure-shape pairs at once:
///     min_(p, x_i)  1/N sum_i 1/2 mean_k (d_RBF(t_i, x_ik)/distance_scale)^2 + 1/2 ((P_i -
///     P_i^measured)/pressure_scale)^2
/// where x_i is the equilibrium of step i. With Control::Volume the volumes are prescribed, the pressures P_i follow
/// and are compared, and one equilibrium serves the samples of every thickness. With Control::Pressure, the thesis'
/// way, the pressures are prescribed and the second term vanishes: past a limit point there is no equilibrium to be
/// found.
struct ShapeFit {
  std::string model{};  ///< in the registry of materials
  std::vector<double>
      start{};           ///< first parameters, SI units; none zero: fits are in the logarithms of their magnitudes
  double radius = 0.03;  ///< of the clamp's opening [m]
  int rings = 6;         ///< of the disc that is simulated, and of the coarser of two
  std::vector<ShapeStep> steps{};
  Control control = Control::Volume;
  /// What counts as one unit of misfit: about the standard errors of the measurement.
  double distance_scale = 5e-5;  ///< [m]
  double pressure_scale = 30;    ///< [Pa]
};

/// The steps of samples that were inflated to the same volumes in an opening of this radius [m]. Each scan becomes an
/// implicit surface that ends at the edge of the opening. Throws InputError where the volumes differ or a scan cannot
/// be used.
std::vector<ShapeStep> shape_steps(const std::vector<MembraneSample>& samples, double radius,
                                   const RbfOptions& options = {});

/// Both formulations throw InputError when the fit makes no sense.
///
/// The parameters alone, z = log |p|: the objective at the equilibria x_i(p), its derivatives from their sensitivities.
/// `restore` refuses parameters at which a step has no equilibrium.
std::unique_ptr<NonlinearProgram> reduced_program(const ShapeFit& fit);

/// Equilibria, pressures and parameters together, z = (x_1/a, P_1/P, ..., log |p|) with x_i the free vertices, force
/// balance and volumes as constraints (3.39). Only for Control::Volume.
std::unique_ptr<NonlinearProgram> full_space_program(const ShapeFit& fit);

/// What a fit found; values are NaN where it has not converged.
struct ShapeFitResult {
  std::vector<double> parameters;    ///< extrapolated to vanishing mesh size, SI units, in the order of the model
  std::vector<double> coarse, fine;  ///< those of the two meshes
  double objective = NAN;            ///< on the fine mesh: 1/2 for each kind of misfit where it is one unit
  Report report;                     ///< of the fit on the fine mesh, or of the coarse one where that fails
};

/// Fits on discs of fit.rings and of twice as many, the second from the optimum of the first. The error of the
/// parameters is of second order in the mesh size, so that (4 fine - coarse)/3, of their logarithms, is free of it
/// (Richardson). Uses the reduced programme. On the coarse mesh the fit is repeated from the other starts, each with
/// the signs of fit.start, and the least objective that converged is kept. Converged means that the gradient is small:
/// one more Gauss-Newton step promises to lower the objective by less than 1e-5 of itself. The logarithms keep every
/// parameter's sign: one that wants to change it goes to zero.
ShapeFitResult fit_shape(const ShapeFit& fit, const std::vector<std::vector<double>>& other_starts = {},
                         const IterationObserver& observer = {});

/// The material of a point z of either programme: the last entries are log |p|.
std::shared_ptr<const Material> fitted_material(const ShapeFit& fit, ConstVec z);
/// The fit's model with these parameters.
std::shared_ptr<const Material> material_of(const ShapeFit& fit, const std::vector<double>& parameters);

}  // namespace softform
