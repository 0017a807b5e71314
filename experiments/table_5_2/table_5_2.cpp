// Purpose: the times of table 5.2 (thesis section 5.6) for every character that exists: its whole pipeline, one after
// the other in one run, with elements, actuators and the equilibria that failed inside the optimisation.
// Claim: the tower takes at most a fifteenth of the thesis' time, the worm a thirtieth, palm and question mark a
// fiftieth. A time counts only where all poses of all stages are stable equilibria.

#include <map>

#include "../character_table.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/io/text_file.hpp"

namespace {

using namespace softform;

struct ThesisRow {
  int elements;
  const char* actuators;
  double time;  // [s]
};
const std::map<std::string, ThesisRow> thesis{{"tour_eiffel", {525, "5", 1202}},
                                              {"palmy_2d", {2745, "4", 19560}},
                                              {"worm_eye", {808, "8", 11400}},
                                              {"question_mark", {4536, "caps", 4140}}};

void measure_times(Run& run)
{
  std::string lines =
      "character,elements,actuators,wall time [s],processor time [s],failed equilibria,thesis elements,"
      "thesis actuators,thesis time [s],thesis time over ours\n";
  int unsound = 0;
  for (const TableCharacter& character : run_characters(run)) {
    const ThesisRow& row = thesis.at(character.name);
    const auto metric = [&](const char* name, double value, const char* unit) {
      run.metric(fmt::format("{}_{}", name, character.name), value, unit);
    };
    metric("time", character.seconds, "s");
    metric("cpu", character.cpu_s, "s");
    metric("thesis_time_over_ours", row.time / character.seconds, "1");
    metric("elements", character.elements, "1");
    metric("actuators", character.actuators, "1");
    metric("failed_equilibria", character.failed_equilibria, "1");
    unsound += character.is_sound ? 0 : 1;
    lines += fmt::format("{},{},{},{:.1f},{:.1f},{},{},{},{:.0f},{:.0f}\n", character.name, character.elements,
                         character.actuators, character.seconds, character.cpu_s, character.failed_equilibria,
                         row.elements, row.actuators, row.time, row.time / character.seconds);
  }
  run.metric("unsound_characters", unsound, "1");
  write_text(run.path("table.csv"), lines);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"table_5_2",
                                   "5.6",
                                   "Whole pipelines take at most a fifteenth (tower), a thirtieth (worm) and a "
                                   "fiftieth (palm, question mark) of the thesis' time.",
                                   {0.5, 6}},
                                  measure_times);
}
