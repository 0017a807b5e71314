// Purpose: the whole pipeline on a palm (thesis section 5.6, figure 5.5, and its rows of tables 5.1 and 5.2): four pins
// found by sparse regularisation, their places moved along the boundary, two materials laid out, for three poses at
// once.
// Claim: every stage brings the poses nearer to their targets, and the layout follows them to the thesis' errors with
// every element one of the two materials, whatever density it starts from; pins lead the palm there from rest without
// buckling.

#include "../pin_figures.hpp"
#include "softform/experiment/experiment.hpp"

namespace {

using namespace softform;

void design_palm(Run& run)
{
  // 1. The three stages.
  PinCharacter palm = make_pin_character("palmy_2d", run.by_size(700, 2745));
  const std::vector<PinStage> stages = run_stages(run, palm);
  report_stages(run, palm, stages);
  write_figure(run, palm, stages);

  // 2. The layout once more, from another first density.
  report_second_start(run, palm, stages, 0.5);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_5_5",
       "5.6",
       "Sparse pins, their places and a layout of two materials bring a palm to three poses.",
       {1, 5}},
      design_palm);
}
