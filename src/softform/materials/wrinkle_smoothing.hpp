#pragma once

namespace softform {

/// First derivatives of an energy density in the squared stretches lambda_1 and lambda_2 [Pa].
struct StretchDerivatives {
  double by_1 = 0, by_2 = 0;
};

/// Of the relaxed energy (6.6). Precondition: lambda_1 >= lambda_2 > 0.
StretchDerivatives relaxed_derivatives(double kappa, double lambda_1, double lambda_2);

/// The quadratic (6.11) that joins the function 0 (a = 0), up to x_I - eps, to c (x - x_I), from x_I + eps on, with the
/// first derivatives of both. t = x - x_I. Precondition: |t| <= eps, eps > 0.
double transition(double t, double c, double eps);

/// Where a kinked function, zero up to some point and f above it, is replaced by transition(): on [u - 2 eps, u], with
/// c = f'(u) and eps = f(u) / c, so that it joins f at u (6.13).
struct TransitionInterval {
  double u, c, eps;

  double start() const { return u - 2 * eps; }
  double intersection() const { return u - eps; }
};

/// The three intervals of the thesis (6.12), (6.13) for fixed lambda_2 or lambda_1, with its parameter delta > 0. The
/// first is as printed, with c taken of the wrinkled branch. The thesis leaves the other two open: theirs end delta
/// times the distance of the stretches beyond the line, which vanishes towards the rest state as the first one does.
TransitionInterval slack_to_wrinkled(double kappa, double delta, double lambda_2);      ///< in lambda_1
TransitionInterval wrinkled_to_taut_by_1(double kappa, double delta, double lambda_2);  ///< of what taut adds
TransitionInterval wrinkled_to_taut_by_2(double kappa, double delta, double lambda_1);  ///< in lambda_2

/// The derivatives with the thesis' own smoothing. They are continuously differentiable in their own variable, but no
/// energy has them: d(by_1)/d lambda_2 and d(by_2)/d lambda_1 differ. For the figures; solvers use TensionField.
StretchDerivatives thesis_smoothed_derivatives(double kappa, double delta, double lambda_1, double lambda_2);

}  // namespace softform
