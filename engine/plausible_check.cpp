#include "engine/plausible_check.h"

#include <string>

#include "base/log.h"
#include "base/number_text.h"
#include "base/options.h"
#include "engine/scene_material.h"

namespace trocar {

namespace {

void warn_of_density(const SceneMaterial& material, const std::string& path) {
  constexpr double least = 100, most = 5000;  // lung is some 200, metal of implants 4500 [kg/m^3]
  const double density = to_material(material).density;
  if (density < least || density > most)
    log_warning(path + ".density: " + short_text(density) +
                " kg/m^3, while water has 1000: check its unit");
}

void warn_of_gravity(const Vec3& gravity) {
  constexpr double most = 100;  // [m/s^2]
  if (gravity.norm() > most)
    log_warning("solver.gravity: " + short_text(gravity.norm()) +
                " m/s^2, while the Earth's is 9.81: check its unit");
}

// The straight way between neighbouring keys; `where` a key is.
template <class Keys, class Where>
void warn_of_speed(const std::string& path, const std::string& who, const Keys& keys,
                   const Where& where) {
  constexpr double most = 10;  // [m/s]
  for (std::size_t j = 1; j < keys.size(); ++j) {
    const double way = (where(keys[j]) - where(keys[j - 1])).norm();
    const double seconds = keys[j].time - keys[j - 1].time;
    if (way <= most * seconds) continue;
    log_warning(path + "." + item_path("path", j) + ": \"" + who + "\" goes " +
                short_text(1e3 * way) + " mm in " + short_text(1e3 * seconds) + " ms, at " +
                short_text(way / seconds) +
                " m/s, which is faster than a hand: check the units of time and place");
  }
}

}  // namespace

void warn_of_implausible(const Scene& scene) {
  warn_of_density(scene.tissue.material, "tissue.material");
  for (std::size_t k = 0; k < scene.tissue.region_materials.size(); ++k)
    warn_of_density(scene.tissue.region_materials[k].material,
                    item_path("tissue.region_material", k) + ".material");
  warn_of_gravity(scene.solver.gravity);
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    warn_of_speed(item_path("instrument", k), scene.instruments[k].name, scene.instruments[k].path,
                  [](const InstrumentKey& key) { return key.position; });
  for (std::size_t k = 0; k < scene.supports.size(); ++k)
    warn_of_speed(item_path("support", k), scene.supports[k].region, scene.supports[k].path,
                  [](const SupportKey& key) { return key.displacement; });
}

}  // namespace trocar
