// Every material, in the order of MaterialModel. A new one is a header and a line here.
#pragma once

#include "solver/material_holzapfel_gasser_ogden.h"
#include "solver/material_linear.h"
#include "solver/material_mooney_rivlin.h"
#include "solver/material_neo_hookean.h"
#include "solver/material_ogden.h"
#include "solver/material_st_venant_kirchhoff.h"
#include "solver/material_transversely_isotropic.h"
#include "solver/material_yeoh.h"
#include "solver/type_list.h"

namespace trocar {

using MaterialList = TypeList<MaterialLinear, MaterialStVenantKirchhoff, MaterialNeoHookean,
                              MaterialMooneyRivlin, MaterialYeoh, MaterialOgden,
                              MaterialTransverselyIsotropic, MaterialHolzapfelGasserOgden>;
inline constexpr int n_material_models = MaterialList::size;

}  // namespace trocar
