// Purpose: the errors of table 5.1 (thesis section 5.6) for every character that exists: largest and mean distance of
// the vertices to the target after each stage, pose by pose, the thesis' numbers beside them.
// Claim: errors fall from stage to stage and end no larger than the thesis'.

#include <map>

#include "../character_table.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/io/text_file.hpp"

namespace {

using namespace softform;

// "max/mean" in mm of table 5.1, by character and stage; empty where the thesis has none.
using ThesisErrors = std::map<std::pair<std::string, int>, std::vector<std::string>>;
const ThesisErrors thesis_errors{
    {{"tour_eiffel", 1}, {"4.8/0.5", "3.0/0.4", "2.8/0.5", "6.4/0.8", "4.4/0.6"}},
    {{"tour_eiffel", 2}, {"3.6/0.5", "2.0/0.4", "3.6/0.5", "5.2/0.6", "3.8/0.6"}},
    {{"palmy_2d", 1}, {"7.1/0.7", "11.0/0.9", "5.7/0.4"}},
    {{"palmy_2d", 2}, {"7.6/0.4", "7.4/0.5", "4.8/0.2"}},
    {{"palmy_2d", 3}, {"5.1/0.5", "5.1/0.3", "2.6/0.1"}},
    {{"question_mark", 2}, {"8.3/0.4"}},
    {{"question_mark", 3}, {"3.1/0.2"}},
};

double mean_error(const StageErrors& row)
{
  double sum = 0;
  for (const PoseError& error : row.poses) sum += error.mean;
  return sum / double(row.poses.size());
}

std::string report(Run& run, const TableCharacter& character)
{
  std::string lines;
  for (const StageErrors& row : character.rows) {
    const auto thesis = thesis_errors.find({character.name, row.stage});
    for (std::size_t i = 0; i < row.poses.size(); ++i) {
      const auto& [max, mean] = row.poses[i];
      run.metric(fmt::format("max_error_{}_{}_pose_{}", character.name, row.stage, i + 1), max, "m");
      run.metric(fmt::format("mean_error_{}_{}_pose_{}", character.name, row.stage, i + 1), mean, "m");
      lines += fmt::format("{},{},{},{:.2f},{:.2f},{}\n", character.name, row.stage, i + 1, 1e3 * max, 1e3 * mean,
                           thesis == thesis_errors.end() ? "" : thesis->second[i]);
    }
    run.metric(fmt::format("mean_error_{}_{}", character.name, row.stage), mean_error(row), "m");
  }
  double largest_ratio = 0;
  for (std::size_t s = 1; s < character.rows.size(); ++s)
    largest_ratio = std::max(largest_ratio, mean_error(character.rows[s]) / mean_error(character.rows[s - 1]));
  run.metric("largest_ratio_of_stages_" + character.name, largest_ratio, "1");
  run.metric("improvement_" + character.name, mean_error(character.rows.front()) / mean_error(character.rows.back()),
             "1");
  run.metric("grey_" + character.name, character.greyness, "1");
  run.metric("is_sound_" + character.name, character.is_sound ? 1 : 0, "1");
  return lines;
}

void measure_errors(Run& run)
{
  std::string lines = "character,stage,pose,max [mm],mean [mm],thesis max/mean [mm]\n";
  for (const TableCharacter& character : run_characters(run)) lines += report(run, character);
  write_text(run.path("table.csv"), lines);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"table_5_1", "5.6", "Errors fall from stage to stage and end no larger than the thesis'.", {0.5, 6}},
      measure_errors);
}
