#include <memory>

#include "support/small_program.hpp"
#include "support/test_programs.hpp"

namespace softform::testing {

std::shared_ptr<const NonlinearProgram> infeasible_program()
{
  return std::make_shared<SmallProgram>(
      Definition{"infeasible",
                 vec({1, 2}),
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(1), x[1]};
                 },
                 none,
                 [](const Numbers& x) { return Numbers{square(x[0]) + square(x[1]) + number(1)}; },
                 {},
                 {}});
}

std::shared_ptr<const NonlinearProgram> unbounded_program()
{
  return std::make_shared<SmallProgram>(Definition{"unbounded",
                                                   vec({1, 2}),
                                                   [](const Numbers& x) { return Numbers{x[1]}; },
                                                   [](const Numbers& x) { return Numbers{x[0]}; },
                                                   none,
                                                   {},
                                                   {}});
}

std::shared_ptr<const NonlinearProgram> undefined_program()
{
  return std::make_shared<SmallProgram>(Definition{"undefined",
                                                   vec({-1, 2}),
                                                   [](const Numbers& x) { return Numbers{x[1]}; },
                                                   [](const Numbers& x) { return Numbers{x[0] * sqrt(x[0])}; },
                                                   none,
                                                   {},
                                                   {}});
}

std::shared_ptr<const NonlinearProgram> irregular_program()
{
  return std::make_shared<SmallProgram>(Definition{"irregular",
                                                   vec({1}),
                                                   none,
                                                   [](const Numbers& x) { return Numbers{x[0]}; },
                                                   [](const Numbers& x) { return Numbers{square(x[0])}; },
                                                   {},
                                                   {}});
}

std::shared_ptr<const NonlinearProgram> parallel_lines_program()
{
  return std::make_shared<SmallProgram>(Definition{"parallel lines",
                                                   vec({3, -1}),
                                                   [](const Numbers& x) { return x; },
                                                   none,
                                                   [](const Numbers& x) {
                                                     return Numbers{x[0] + x[1], x[0] + x[1] - number(2)};
                                                   },
                                                   {},
                                                   {}});
}

std::shared_ptr<const NonlinearProgram> unbounded_on_a_line_program()
{
  return std::make_shared<SmallProgram>(Definition{"unbounded on a line",
                                                   vec({1, 1}),
                                                   none,
                                                   [](const Numbers& x) { return Numbers{-x[0] - square(x[1])}; },
                                                   [](const Numbers& x) { return Numbers{x[0] - x[1]}; },
                                                   {},
                                                   {}});
}

std::shared_ptr<const NonlinearProgram> logarithmic_program()
{
  return std::make_shared<SmallProgram>(Definition{
      "logarithmic", vec({10}), none, [](const Numbers& x) { return Numbers{x[0] - log(x[0])}; }, none, {}, {}});
}

}  // namespace softform::testing
