#include "softform/fitting/least_squares_as_program.hpp"

#include <limits>
#include <utility>

namespace softform {
namespace {

class Program final : public LeastSquaresProgram {
 public:
  Program(std::shared_ptr<const LeastSquaresProblem> problem, Vec start, Vec lower, Vec upper)
      : problem_(std::move(problem)), start_(std::move(start)), lower_(std::move(lower)), upper_(std::move(upper))
  {}

  std::string name() const override { return "least squares"; }
  int variable_count() const override { return problem_->parameter_count(); }
  int residual_count() const override { return problem_->residual_count(); }
  Vec initial_point() const override { return start_; }
  Vec lower_bounds() const override { return lower_; }
  Vec upper_bounds() const override { return upper_; }

  void residuals(ConstVec z, Vec& r) const override
  {
    if (!problem_->evaluate(z, r, nullptr)) r.setConstant(residual_count(), std::numeric_limits<double>::quiet_NaN());
  }
  void residual_jacobian(ConstVec z, SparseMatrix& R) const override
  {
    Vec r;
    Eigen::MatrixXd J;
    if (!problem_->evaluate(z, r, &J))
      J.setConstant(residual_count(), variable_count(), std::numeric_limits<double>::quiet_NaN());
    // Every entry is stored, zeros too: the pattern stays.
    R.resize(J.rows(), J.cols());
    R.reserve(Eigen::VectorXi::Constant(J.cols(), static_cast<int>(J.rows())));
    for (int j = 0; j < J.cols(); ++j)
      for (int i = 0; i < J.rows(); ++i) R.insert(i, j) = J(i, j);
    R.makeCompressed();
  }

 private:
  std::shared_ptr<const LeastSquaresProblem> problem_;
  Vec start_, lower_, upper_;
};

}  // namespace

std::unique_ptr<LeastSquaresProgram> least_squares_program(std::shared_ptr<const LeastSquaresProblem> problem,
                                                           Vec start, Vec lower, Vec upper)
{
  return std::make_unique<Program>(std::move(problem), std::move(start), std::move(lower), std::move(upper));
}

}  // namespace softform
