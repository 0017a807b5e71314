// Purpose: the whole pipeline on a worm (thesis section 5.6, figure 5.6, and its row of table 5.2): eight pins found by
// sparse regularisation, their places moved along the boundary, two materials laid out, for four poses at once.
// Claim: every stage brings the poses nearer to their targets, with every element one of the two materials at the end,
// whatever density it starts from; pins lead the worm there from rest without buckling.

#include "../pin_figures.hpp"
#include "softform/experiment/experiment.hpp"

namespace {

using namespace softform;

void design_worm(Run& run)
{
  // 1. The three stages.
  PinCharacter worm = make_pin_character("worm_eye", run.by_size(400, 808));
  const std::vector<PinStage> stages = run_stages(run, worm);
  report_stages(run, worm, stages);
  write_figure(run, worm, stages);

  // 2. The layout once more, from another first density.
  report_second_start(run, worm, stages, 0.5);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"fig_5_6", "5.6", "Eight pins and a layout of two materials bring a worm to its poses.", {0.5, 2}},
      design_worm);
}
