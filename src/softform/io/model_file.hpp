#pragma once

#include <filesystem>

#include "softform/mesh/implicit_model.hpp"

namespace softform {

/// The keys of a model file in words, for --help.
extern const char* const model_file_help;

/// Reads an implicit model (datasets/models/*.json), in metres. Unknown keys are refused.
/// Throws InputError naming the file, the part and the cure.
ImplicitModel read_model(const std::filesystem::path& file);

}  // namespace softform
