#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "softform/characters/posed_mesh.hpp"
#include "softform/io/json_entry_internal.hpp"

/// What the readers of a character's file share.
namespace softform::character_file {

using Body = std::variant<PosedMesh<2>, PosedMesh<3>>;

/// A body and its poses from the entry "body". `folder` is what files are relative to, `unit` [m] that of plain
/// coordinates; a planar body sets the thickness [m].
Body read_body(const JsonEntry& body, const std::filesystem::path& folder, double unit, double& thickness);

/// A number above 0, or a value with a unit above 0.
double positive(const JsonEntry& entry);
double positive(const JsonEntry& entry, double (*parse)(const std::string&));

/// The entries of a list of `count`.
std::vector<JsonEntry> list_of(const JsonEntry& entry, const std::string& key, std::size_t count,
                               const std::string& item);

}  // namespace softform::character_file
