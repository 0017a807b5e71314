#pragma once

#include <map>
#include <string>

namespace softform {

/// What a run was, beside what can be asked of the machine and the build.
struct Provenance {
  std::string experiment, outcome, size;
  unsigned seed = 0;
  int threads = 1;
  std::string started, finished;                ///< UTC, ISO 8601
  std::map<std::string, std::string> datasets;  ///< id -> SHA-256
};

/// The run with commit, compiler, flags, processor and BLAS, as JSON: BLAS and thread count change the last digits.
std::string provenance_json(const Provenance& run);

/// Now, as 2024-01-31T12:00:00Z.
std::string utc_now();

}  // namespace softform
