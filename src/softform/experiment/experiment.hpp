#pragma once

#include <functional>
#include <string>

#include "softform/experiment/run.hpp"

namespace softform {

/// Rough run times on two cores, for `./reproduce list`.
struct Minutes {
  double quick = 0;
  double paper = 0;
};

/// What an experiment is: the one place where its claim is stated.
struct ExperimentInfo {
  std::string id;       ///< as its folder: "fig_4_6"
  std::string section;  ///< of the thesis: "4.6"
  std::string claim;    ///< one sentence
  Minutes minutes;
};

/// The main function of an experiment: reads the command line (--size, --out, --threads, --seed, --list, --help), runs
/// `body` and writes results/<id>/ (paper) or results/quick/<id>/ (quick) of the source tree, or --out.
/// Returns the exit code: 0 done, 1 failed, 2 bad input, 130 interrupted; what was computed until then is written.
int run_experiment(int argc, char** argv, const ExperimentInfo& info, const std::function<void(Run&)>& body);

}  // namespace softform
