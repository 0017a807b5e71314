// NLopt, Ceres and IPOPT through our interface: known optima and multipliers in our signs, broken programmes, limits.

#include <gtest/gtest.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/least_squares_program.hpp"
#include "softform/optimizers/registry.hpp"
#include "softform/optimizers/sqp.hpp"
#include "support/small_program.hpp"
#include "support/test_programs.hpp"

namespace softform::testing {
namespace {

constexpr StopCriteria tight{.max_iterations = 500, .max_time_s = 20, .relative_decrease = 0};

// HS 6, 7, 28 and 39, and Maratos'.
std::vector<PublishedProgram> equality_problems()
{
  std::vector<PublishedProgram> problems;
  for (const char* name : {"HS 6", "HS 7", "HS 28", "HS 39"}) problems.push_back(published_program(name));
  problems.push_back(maratos_program());
  return problems;
}

/// Rosenbrock's residuals (10 (y - x^2), 1 - x) with x <= limit: for limit < 1 the optimum is (limit, limit^2), where
/// the bound's multiplier is limit - 1.
class Rosenbrock : public LeastSquaresProgram {
 public:
  explicit Rosenbrock(double limit = HUGE_VAL) : limit_(limit) {}
  std::string name() const override { return "rosenbrock"; }
  int variable_count() const override { return 2; }
  int residual_count() const override { return 2; }
  Vec initial_point() const override { return vec({-1.2, 1}); }
  Vec upper_bounds() const override { return vec({limit_, HUGE_VAL}); }
  void residuals(ConstVec z, Vec& r) const override { r = vec({10 * (z[1] - z[0] * z[0]), 1 - z[0]}); }
  void residual_jacobian(ConstVec z, SparseMatrix& R) const override
  {
    R.resize(2, 2);
    R.insert(0, 0) = -20 * z[0];
    R.insert(1, 0) = -1;
    R.insert(0, 1) = 10;
    R.makeCompressed();
  }

 private:
  double limit_;
};

bool is_adapter(const OptimizerEntry& entry)
{
  return entry.name.starts_with("nlopt") || entry.name == "ceres" || entry.name == "ipopt";
}

std::vector<OptimizerEntry> adapters(bool for_constraints)
{
  std::vector<OptimizerEntry> found;
  for (const OptimizerEntry& entry : optimizers())
    if (is_adapter(entry) && (entry.takes_constraints || !for_constraints)) found.push_back(entry);
  return found;
}

TEST(Adapters, AreInTheRegistry)
{
  EXPECT_GE(adapters(true).size(), 2U);
  EXPECT_GE(adapters(false).size(), 5U);
}

TEST(Adapters, FindOptimaAndMultipliersUnderConstraints)
{
  for (const OptimizerEntry& entry : adapters(true)) {
    for (const PublishedProgram& published : equality_problems()) {
      const auto& program = published.program;
      SCOPED_TRACE(entry.name + " on " + program->name());
      const Solution solution = entry.make()->minimize(*program, tight);
      EXPECT_TRUE(solution.report.converged()) << solution.report.message;
      const double tolerance = entry.name == "ipopt" ? 1e-6 : 1e-4;
      EXPECT_LT((solution.z - published.optimum).lpNorm<Eigen::Infinity>(), tolerance) << solution.z.transpose();
      EXPECT_LT((solution.lagrange_multipliers - published.lagrange_multipliers).lpNorm<Eigen::Infinity>(), tolerance)
          << solution.lagrange_multipliers.transpose();
      EXPECT_EQ(solution.objective, program->objective(solution.z));
      EXPECT_GT(solution.report.evaluations.value, 1);
      EXPECT_GT(solution.report.evaluations.jacobian, 1);
    }
  }
}

TEST(Adapters, FindOptimaAndMultipliersAtBounds)
{
  for (const double limit : {0.5, 2.0}) {
    const Rosenbrock program(limit);
    const double x = std::min(1.0, limit);
    for (const OptimizerEntry& entry : adapters(false)) {
      SCOPED_TRACE(entry.name);
      const Solution solution = entry.make()->minimize(program, tight);
      // Mma crawls along the valley's floor for thousands of evaluations.
      if (entry.name != "nlopt_mma" || limit < 1) {
        EXPECT_TRUE(solution.report.converged()) << solution.report.message;
      }
      EXPECT_LT((solution.z - vec({x, x * x})).lpNorm<Eigen::Infinity>(), 1e-5) << solution.z.transpose();
      EXPECT_LE(solution.z[0], limit);
      EXPECT_NEAR(solution.bound_multipliers[0], x - 1, 1e-5);
      EXPECT_NEAR(solution.bound_multipliers[1], 0, 1e-5);
      EXPECT_FALSE(solution.report.trace.empty());
    }
  }
}

TEST(Adapters, IpoptAgreesWithSqp)
{
  for (const OptimizerEntry& entry : adapters(true)) {
    if (entry.name != "ipopt") continue;
    for (const PublishedProgram& published : equality_problems()) {
      const auto& program = published.program;
      const Solution theirs = entry.make()->minimize(*program, tight), ours = Sqp().minimize(*program, tight);
      EXPECT_LT((theirs.z - ours.z).lpNorm<Eigen::Infinity>(), 1e-6) << program->name();
      EXPECT_LT((theirs.lagrange_multipliers - ours.lagrange_multipliers).lpNorm<Eigen::Infinity>(), 1e-6);
    }
  }
}

TEST(Adapters, SayWhatIsBroken)
{
  for (const OptimizerEntry& entry : adapters(true)) {
    SCOPED_TRACE(entry.name);
    for (const Solution& solution : {entry.make()->minimize(*parallel_lines_program(), tight),
                                     entry.make()->minimize(*unbounded_on_a_line_program(), tight)}) {
      EXPECT_FALSE(solution.report.converged()) << solution.report.message;
      EXPECT_NE(solution.report.message, "");
    }
  }
  for (const OptimizerEntry& entry : adapters(false)) {
    if (entry.needs_residuals) continue;
    SCOPED_TRACE(entry.name);
    const Solution solution = entry.make()->minimize(*undefined_program(), tight);
    EXPECT_EQ(solution.report.termination, Termination::NotFinite) << solution.report.message;
  }
}

/// Residuals that are not finite anywhere.
class NotFinite : public Rosenbrock {
 public:
  void residuals(ConstVec, Vec& r) const override { r = Vec::Constant(2, std::nan("")); }
};

TEST(Adapters, CeresSaysWhenResidualsAreNotFinite)
{
  EXPECT_EQ(make_optimizer("ceres")->minimize(NotFinite(), tight).report.termination, Termination::NotFinite);
}

TEST(Adapters, RespectLimits)
{
  for (const OptimizerEntry& entry : adapters(false)) {
    SCOPED_TRACE(entry.name);
    const Rosenbrock program;
    const auto method = entry.make();
    const Solution interrupted = method->minimize(program, tight, [](const Iterate& it) { return it.k < 2; });
    EXPECT_EQ(interrupted.report.termination, Termination::Interrupted) << interrupted.report.message;
    EXPECT_TRUE(interrupted.z.allFinite());
    const Solution late = method->minimize(program, {.max_time_s = 0, .relative_decrease = 0});
    EXPECT_EQ(late.report.termination, Termination::TimeLimit) << late.report.message;
    const Solution few = method->minimize(program, {.max_iterations = 1, .relative_decrease = 0});
    EXPECT_EQ(few.report.termination, Termination::IterationLimit) << few.report.message;
  }
}

TEST(Adapters, RefuseWhatTheyDoNotTake)
{
  const NonlinearProgram& constrained = *published_program("HS 7").program;
  const auto without_residuals = logarithmic_program();
  EXPECT_THROW(make_optimizer("nlopt_lbfgs")->minimize(constrained), InputError);
  EXPECT_THROW(make_optimizer("nlopt_mma")->minimize(constrained), InputError);
  EXPECT_THROW(make_optimizer("ceres")->minimize(*without_residuals), InputError);
}

}  // namespace
}  // namespace softform::testing
