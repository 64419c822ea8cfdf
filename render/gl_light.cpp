#include "render/gl_light.h"

#include "render/shader_light.h"
#include "render/shader_surface.h"

namespace trocar {

static constexpr const char* glsl_version = "#version 330 core\n";

std::string surface_vertex(bool is_tissue) {
  return std::string(glsl_version) + (is_tissue ? "#define IS_TISSUE\n" : "") +
         shader_surface_vertex;
}

std::string with_light(const char* shader) {
  return std::string(glsl_version) + shader_light + shader;
}

void use_with_view(const GlProgram& program, const View& view) {
  program.use();
  program.set("projection", view.projection);
  program.set("lamp_projection", view.lamp_projection);
  program.set("eye", view.eye);
  program.set("lamp", view.lamp);
  program.set("forward", view.forward);
  program.set("right", view.right);
  program.set("up", view.up);
  program.set("distance_scale", view.distance);
  program.set("tan_half", view.tan_half_height * view.aspect, view.tan_half_height);
  program.set("near_far", view.near, view.far);
}

}  // namespace trocar
