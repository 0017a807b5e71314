#include "support/test_programs.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "support/small_program.hpp"

namespace softform::testing {
namespace {

PublishedProgram published(Definition definition, const std::vector<double>& optimum,
                           const std::vector<double>& multipliers, const std::vector<double>& bound_multipliers = {})
{
  const Vec at_bounds = bound_multipliers.empty() ? Vec::Zero(definition.start.size()) : vec(bound_multipliers);
  return {std::make_shared<SmallProgram>(std::move(definition)), vec(optimum), vec(multipliers), at_bounds};
}

PublishedProgram degenerate(PublishedProgram program)
{
  program.is_degenerate = true;
  return program;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0), pi = std::acos(-1.0);

Numbers rosenbrock(const Numbers& x) { return {number(10) * (x[1] - square(x[0])), number(1) - x[0]}; }

// HS 52 and 53 differ in one coefficient of the objective.
Functions residuals_52(double factor)
{
  return [factor](const Numbers& x) {
    return Numbers{number(factor) * x[0] - x[1], x[1] + x[2] - number(2), x[3] - number(1), x[4] - number(1)};
  };
}
Numbers constraints_52(const Numbers& x)
{
  return {x[0] + number(3) * x[1], x[2] + x[3] - number(2) * x[4], x[1] - x[4]};
}

// Without constraints.
std::vector<PublishedProgram> bounded_programs()
{
  return {
      published({"Rosenbrock", vec({-1.2, 1}), rosenbrock, none, none, {}, {}}, {1, 1}, {}),
      published({"domain that ends",
                 vec({3}),
                 none,
                 [](const Numbers& x) { return Numbers{x[0] - log(x[0])}; },
                 none,
                 {},
                 {}},
                {1}, {}),
      published({"HS 1", vec({-2, 1}), rosenbrock, none, none, vec({-infinity, -1.5}), vec({infinity, infinity})},
                {1, 1}, {}),
      published(
          {"HS 3", vec({10, 1}), [](const Numbers& x) { return Numbers{number(std::sqrt(1e-5)) * (x[1] - x[0])}; },
           [](const Numbers& x) { return Numbers{x[1]}; }, none, vec({-infinity, 0}), vec({infinity, infinity})},
          {0, 0}, {}, {0, 1}),
      published({"HS 4", vec({1.125, 0.125}), none,
                 [](const Numbers& x) { return Numbers{cube(x[0] + number(1)) / number(3) + x[1]}; }, none, vec({1, 0}),
                 vec({infinity, infinity})},
                {1, 0}, {}, {4, 1}),
      published({"HS 5", vec({0, 0}), [](const Numbers& x) { return Numbers{x[0] - x[1]}; },
                 [](const Numbers& x) {
                   return Numbers{sin(x[0] + x[1]) - number(1.5) * x[0] + number(2.5) * x[1] + number(1)};
                 },
                 none, vec({-1.5, -3}), vec({4, 3})},
                {0.5 - pi / 3, -0.5 - pi / 3}, {}),
      published({"HS 38", vec({-3, -1, -3, -1}),
                 [](const Numbers& x) {
                   return Numbers{number(10) * (x[1] - square(x[0])),
                                  number(1) - x[0],
                                  number(std::sqrt(90)) * (x[3] - square(x[2])),
                                  number(1) - x[2],
                                  number(std::sqrt(10.1)) * (x[1] - number(1)),
                                  number(std::sqrt(10.1)) * (x[3] - number(1))};
                 },
                 [](const Numbers& x) { return Numbers{number(19.8) * (x[1] - number(1)) * (x[3] - number(1))}; }, none,
                 Vec::Constant(4, -10), Vec::Constant(4, 10)},
                {1, 1, 1, 1}, {}),
      published({"HS 45", Vec::Constant(5, 2), none,
                 [](const Numbers& x) { return Numbers{number(2) - x[0] * x[1] * x[2] * x[3] * x[4] / number(120)}; },
                 none, Vec::Zero(5), vec({1, 2, 3, 4, 5})},
                {1, 2, 3, 4, 5}, {}, {-1, -0.5, -1.0 / 3, -0.25, -0.2}),
  };
}

// Linear constraints.
std::vector<PublishedProgram> linear_programs()
{
  return {
      published({"HS 28",
                 vec({-4, 1, 1}),
                 [](const Numbers& x) {
                   return Numbers{x[0] + x[1], x[1] + x[2]};
                 },
                 none,
                 [](const Numbers& x) { return Numbers{x[0] + number(2) * x[1] + number(3) * x[2] - number(1)}; },
                 {},
                 {}},
                {0.5, -0.5, 0.5}, {0}),
      published(
          {"HS 41", Vec::Constant(4, 2), none, [](const Numbers& x) { return Numbers{number(2) - x[0] * x[1] * x[2]}; },
           [](const Numbers& x) { return Numbers{x[0] + number(2) * x[1] + number(2) * x[2] - x[3]}; }, Vec::Zero(4),
           vec({1, 1, 1, 2})},
          {2.0 / 3, 1.0 / 3, 1.0 / 3, 2}, {1.0 / 9}, {0, 0, 0, -1.0 / 9}),
      published(
          {"HS 48",
           vec({3, 5, -3, 2, -2}),
           [](const Numbers& x) {
             return Numbers{x[0] - number(1), x[1] - x[2], x[3] - x[4]};
           },
           none,
           [](const Numbers& x) {
             return Numbers{x[0] + x[1] + x[2] + x[3] + x[4] - number(5), x[2] - number(2) * (x[3] + x[4]) + number(3)};
           },
           {},
           {}},
          {1, 1, 1, 1, 1}, {0, 0}),
      published({"HS 50",
                 vec({35, -31, 11, 5, -5}),
                 [](const Numbers& x) {
                   return Numbers{x[0] - x[1], x[1] - x[2], square(x[2] - x[3]), x[3] - x[4]};
                 },
                 none,
                 [](const Numbers& x) {
                   Numbers c;
                   for (std::size_t i = 0; i < 3; ++i)
                     c.push_back(x[i] + number(2) * x[i + 1] + number(3) * x[i + 2] - number(6));
                   return c;
                 },
                 {},
                 {}},
                {1, 1, 1, 1, 1}, {0, 0, 0}),
      published({"HS 51",
                 vec({2.5, 0.5, 2, -1, 0.5}),
                 residuals_52(1),
                 none,
                 [](const Numbers& x) {
                   return Numbers{x[0] + number(3) * x[1] - number(4), x[2] + x[3] - number(2) * x[4], x[1] - x[4]};
                 },
                 {},
                 {}},
                {1, 1, 1, 1, 1}, {0, 0, 0}),
      published({"HS 52", Vec::Constant(5, 2), residuals_52(4), none, constraints_52, {}, {}},
                {-33.0 / 349, 11.0 / 349, 180.0 / 349, -158.0 / 349, 11.0 / 349},
                {1144.0 / 349, 1014.0 / 349, -2704.0 / 349}),
      published({"HS 53", Vec::Constant(5, 2), residuals_52(1), none, constraints_52, Vec::Constant(5, -10),
                 Vec::Constant(5, 10)},
                {-33.0 / 43, 11.0 / 43, 27.0 / 43, -5.0 / 43, 11.0 / 43}, {88.0 / 43, 96.0 / 43, -256.0 / 43}),
      published({"dependent constraints",
                 vec({3, -2}),
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(1), x[1] - number(2)};
                 },
                 none,
                 [](const Numbers& x) {
                   const Number c = x[0] + x[1] - number(2);
                   return Numbers{c, number(2) * c};
                 },
                 {},
                 {}},
                {0.5, 1.5}, {}),
  };
}

// Nonlinear constraints. The digits of HS 60, 63, 71 and 77-79 beyond the published ones are Newton's on the
// first-order conditions, from the published optimum.
std::vector<PublishedProgram> nonlinear_programs()
{
  const double x8 = std::sqrt((25 + std::sqrt(301)) / 2);
  return {
      published({"HS 6",
                 vec({-1.2, 1}),
                 [](const Numbers& x) { return Numbers{number(1) - x[0]}; },
                 none,
                 [](const Numbers& x) { return Numbers{number(10) * (x[1] - square(x[0]))}; },
                 {},
                 {}},
                {1, 1}, {0}),
      published({"HS 7",
                 vec({2, 2}),
                 none,
                 [](const Numbers& x) { return Numbers{log(number(1) + square(x[0])) - x[1]}; },
                 [](const Numbers& x) { return Numbers{square(number(1) + square(x[0])) + square(x[1]) - number(4)}; },
                 {},
                 {}},
                {0, root3}, {1 / (2 * root3)}),
      published({"HS 8",
                 vec({2, 1}),
                 none,
                 [](const Numbers&) { return Numbers{number(-1)}; },
                 [](const Numbers& x) {
                   return Numbers{square(x[0]) + square(x[1]) - number(25), x[0] * x[1] - number(9)};
                 },
                 {},
                 {}},
                {x8, 9 / x8}, {0, 0}),
      degenerate(published({"HS 26",
                            vec({-2.6, 2, 2}),
                            [](const Numbers& x) {
                              return Numbers{x[0] - x[1], square(x[1] - x[2])};
                            },
                            none,
                            [](const Numbers& x) {
                              return Numbers{(number(1) + square(x[1])) * x[0] + square(square(x[2])) - number(3)};
                            },
                            {},
                            {}},
                           {1, 1, 1}, {0})),
      published({"HS 27",
                 vec({2, 2, 2}),
                 [](const Numbers& x) {
                   return Numbers{number(0.1) * (x[0] - number(1)), x[1] - square(x[0])};
                 },
                 none,
                 [](const Numbers& x) { return Numbers{x[0] + square(x[2]) + number(1)}; },
                 {},
                 {}},
                {-1, 1, 0}, {0.04}),
      published({"HS 39",
                 Vec::Constant(4, 2),
                 none,
                 [](const Numbers& x) { return Numbers{-x[0]}; },
                 [](const Numbers& x) {
                   return Numbers{x[1] - cube(x[0]) - square(x[2]), square(x[0]) - x[1] - square(x[3])};
                 },
                 {},
                 {}},
                {1, 1, 0, 0}, {-1, -1}),
      published(
          {"HS 40",
           Vec::Constant(4, 0.8),
           none,
           [](const Numbers& x) { return Numbers{-x[0] * x[1] * x[2] * x[3]}; },
           [](const Numbers& x) {
             return Numbers{cube(x[0]) + square(x[1]) - number(1), square(x[0]) * x[3] - x[2], square(x[3]) - x[1]};
           },
           {},
           {}},
          {std::pow(2, -1.0 / 3), std::pow(2, -0.5), std::pow(2, -11.0 / 12), std::pow(2, -0.25)},
          {0.5, -std::pow(2, -13.0 / 12), std::pow(2, -1.5)}),
      published({"HS 42",
                 Vec::Constant(4, 1),
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(1), x[1] - number(2), x[2] - number(3), x[3] - number(4)};
                 },
                 none,
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(2), square(x[2]) + square(x[3]) - number(2)};
                 },
                 {},
                 {}},
                {2, 2, 0.6 * root2, 0.8 * root2}, {-2, 2.5 * root2 - 1}),
      published({"HS 60", Vec::Constant(3, 2),
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(1), x[0] - x[1], square(x[1] - x[2])};
                 },
                 none,
                 [](const Numbers& x) {
                   return Numbers{x[0] * (number(1) + square(x[1])) + square(square(x[2])) - number(4 + 3 * root2)};
                 },
                 Vec::Constant(3, -10), Vec::Constant(3, 10)},
                {1.104859019733, 1.196674182288, 1.535262260325}, {-0.01072672788835}),
      published({"HS 63", Vec::Constant(3, 2), none,
                 [](const Numbers& x) {
                   return Numbers{number(1000) - square(x[0]) - number(2) * square(x[1]) - square(x[2]) - x[0] * x[1] -
                                  x[0] * x[2]};
                 },
                 [](const Numbers& x) {
                   return Numbers{number(8) * x[0] + number(14) * x[1] + number(7) * x[2] - number(56),
                                  square(x[0]) + square(x[1]) + square(x[2]) - number(25)};
                 },
                 Vec::Zero(3), Vec::Constant(3, infinity)},
                {3.512121341875, 0.2169879415152, 3.552171154827}, {0.2749371020656, 1.223463560484}),
      published({"HS 71, with a slack", vec({1, 5, 5, 1, 0}), none,
                 [](const Numbers& x) { return Numbers{x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]}; },
                 [](const Numbers& x) {
                   return Numbers{square(x[0]) + square(x[1]) + square(x[2]) + square(x[3]) - number(40),
                                  x[0] * x[1] * x[2] * x[3] - number(25) - x[4]};
                 },
                 vec({1, 1, 1, 1, 0}), vec({5, 5, 5, 5, infinity})},
                {1, 4.742999637264, 3.821149984185, 1.379408293173, 0}, {0.1614685667705, -0.5522936601207},
                {1.087871228667, 0, 0, 0, 0.5522936601207}),
      published({"HS 77",
                 Vec::Constant(5, 2),
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(1), x[0] - x[1], x[2] - number(1), square(x[3] - number(1)),
                                  cube(x[4] - number(1))};
                 },
                 none,
                 [](const Numbers& x) {
                   return Numbers{square(x[0]) * x[3] + sin(x[3] - x[4]) - number(2 * root2),
                                  x[1] + square(square(x[2])) * square(x[3]) - number(8 + root2)};
                 },
                 {},
                 {}},
                {1.166172189709, 1.182111388803, 1.380257043145, 1.506036273623, 0.6109201960431},
                {-0.08553959704282, -0.03187839818681}),
      published({"HS 78",
                 vec({-2, 1.5, 2, -1, -1}),
                 none,
                 [](const Numbers& x) { return Numbers{x[0] * x[1] * x[2] * x[3] * x[4]}; },
                 [](const Numbers& x) {
                   Number sum = number(-10);
                   for (const Number& xi : x) sum += square(xi);
                   return Numbers{sum, x[1] * x[2] - number(5) * x[3] * x[4], cube(x[0]) + cube(x[1]) + number(1)};
                 },
                 {},
                 {}},
                {-1.717143570394, 1.595709690184, 1.827245752927, -0.7636430781841, -0.7636430781841},
                {0.7444459309752, -0.7035751900173, 0.09680552489507}),
      published({"HS 79",
                 Vec::Constant(5, 2),
                 [](const Numbers& x) {
                   return Numbers{x[0] - number(1), x[0] - x[1], x[1] - x[2], square(x[2] - x[3]), square(x[3] - x[4])};
                 },
                 none,
                 [](const Numbers& x) {
                   return Numbers{x[0] + square(x[1]) + cube(x[2]) - number(2 + 3 * root2),
                                  x[1] - square(x[2]) + x[3] + number(2 - 2 * root2), x[0] * x[4] - number(2)};
                 },
                 {},
                 {}},
                {1.191127456311, 1.362603164962, 1.472817931512, 1.635016619168, 1.679081436166},
                {-0.03882104852265, -0.01672651703249, -0.0002873278136941}),
  };
}

}  // namespace

const std::vector<PublishedProgram>& published_programs()
{
  static const std::vector<PublishedProgram> programs = [] {
    std::vector<PublishedProgram> all;
    for (auto group : {bounded_programs(), linear_programs(), nonlinear_programs()})
      all.insert(all.end(), group.begin(), group.end());
    return all;
  }();
  return programs;
}

const PublishedProgram& published_program(const std::string& name)
{
  for (const PublishedProgram& published : published_programs())
    if (published.program->name() == name) return published;
  throw std::invalid_argument("no published programme " + name);
}

PublishedProgram maratos_program()
{
  return published(
      {"Maratos",
       vec({std::cos(0.5), std::sin(0.5)}),
       none,
       [](const Numbers& x) { return Numbers{number(2) * (square(x[0]) + square(x[1]) - number(1)) - x[0]}; },
       [](const Numbers& x) { return Numbers{square(x[0]) + square(x[1]) - number(1)}; },
       {},
       {}},
      {1, 0}, {-1.5});
}

}  // namespace softform::testing
