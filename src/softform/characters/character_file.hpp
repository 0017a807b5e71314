#pragma once

#include <filesystem>

#include "softform/characters/character_task.hpp"

namespace softform {

/// The keys of a task file in words, for --help.
extern const char* const character_file_help;

/// Reads a task (JSON) and all that it names. Throws InputError naming the file, the key and the cure for all that can
/// be known to fail before anything is computed.
CharacterTask read_character_task(const std::filesystem::path& file);

}  // namespace softform
