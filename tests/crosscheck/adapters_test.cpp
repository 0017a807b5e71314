// NLopt, Ceres and IPOPT through our interface: known optima and multipliers in our signs, broken programmes, limits.

#include <gtest/gtest.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/registry.hpp"
#include "softform/optimizers/sqp.hpp"
#include "support/small_programs.hpp"

namespace softform::testing {
namespace {

constexpr StopCriteria tight{.max_iterations = 500, .relative_decrease = 0};

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
    for (const auto& [program, optimum] : equality_problems()) {
      SCOPED_TRACE(entry.name + " on " + program->name());
      const Solution solution = entry.make()->minimize(*program, tight);
      EXPECT_TRUE(solution.report.converged()) << solution.report.message;
      const double tolerance = entry.name == "ipopt" ? 1e-6 : 1e-4;
      EXPECT_LT((solution.z - optimum.z).lpNorm<Eigen::Infinity>(), tolerance) << solution.z.transpose();
      EXPECT_LT((solution.lagrange_multipliers - optimum.lambda).lpNorm<Eigen::Infinity>(), tolerance)
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
    for (const auto& [program, optimum] : equality_problems()) {
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
    for (const Solution& solution : {entry.make()->minimize(AutoProgram<InfeasibleCurve>(), tight),
                                     entry.make()->minimize(AutoProgram<UnboundedBelow>(), tight)}) {
      EXPECT_FALSE(solution.report.converged()) << solution.report.message;
      EXPECT_NE(solution.report.message, "");
    }
  }
  for (const OptimizerEntry& entry : adapters(false)) {
    if (entry.needs_residuals) continue;
    SCOPED_TRACE(entry.name);
    const Solution solution = entry.make()->minimize(AutoProgram<NotFiniteAtStart>(), tight);
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
  const AutoProgram<Hs7> constrained;
  const AutoProgram<LogBarrier> without_residuals;
  EXPECT_THROW(make_optimizer("nlopt_lbfgs")->minimize(constrained), InputError);
  EXPECT_THROW(make_optimizer("nlopt_mma")->minimize(constrained), InputError);
  EXPECT_THROW(make_optimizer("ceres")->minimize(without_residuals), InputError);
}

}  // namespace
}  // namespace softform::testing
