// Tissues by name: starting values with their sources. To change a tissue, change tissue_table.cpp.
#pragma once

#include <string>
#include <vector>

#include "engine/scene_material.h"

namespace trocar {

struct Tissue {
  const char* name;
  SceneMaterial material;  // absent: the defaults
  const char* source;      // of the numbers, and which of them have none
};

const std::vector<Tissue>& tissue_table();
// nullptr if there is none of that name.
const Tissue* find_tissue(const std::string& name);
// Their names.
std::vector<std::string> known_tissues();
// Plain text, and Markdown for docs/tissues.md.
std::string tissues_text();
std::string tissues_markdown();

}  // namespace trocar
