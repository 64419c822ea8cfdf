// The endoscope's lamp and what it lights, in the shaders' uniforms.
#pragma once

#include <string>

#include "render/gl_program.h"
#include "render/view.h"

namespace trocar {

// The vertex shader of surfaces; of tissue it looks up the pattern's widest bumps.
std::string surface_vertex(bool is_tissue);
// A surface's fragment shader, whole.
std::string with_light(const char* shader);
// Uses the program and tells it of eye and lamp.
void use_with_view(const GlProgram& program, const View& view);

}  // namespace trocar
