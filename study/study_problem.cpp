#include "study/study_problem.h"

#include "solver/element_setup.h"

namespace trocar {

std::vector<Problem> built_in_problems() {
  return {problem_indentation(), problem_bonded_cube(), problem_lame_mode(),
          problem_bending_column()};
}

std::vector<Method> solid_methods() {
  std::vector<Method> solid;
  for (const Method& method : methods())
    if (shape_of(method.formulation) != ElementType::tri3) solid.push_back(method);
  return solid;
}

}  // namespace trocar
