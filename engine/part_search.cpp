#include "engine/part_search.h"

#include <algorithm>
#include <cmath>

#include "base/sort_unique.h"
#include "engine/body_search.h"
#include "engine/gather_items.h"
#include "engine/patch.h"
#include "solver/frequency.h"

namespace trocar {

namespace {

// Of all ranks; none where a rank alone has more than `most`. Collective.
std::vector<GrownElement> grown_elements(const Simulation& s, double growth, std::size_t most) {
  const std::vector<GrownElement> mine =
      find_grown(s.model, s.part, s.state, *s.look.stiffening, growth, most);
  if (s.communicator->all_max(static_cast<double>(mine.size())) > static_cast<double>(most))
    return {};
  std::vector<GrownElement> grown = all_gather_items(*s.communicator, mine);
  sort_unique_by(grown, &GrownElement::element);  // several ranks may have told of one
  return grown;
}

// Growth of omega^2 since the search of the body, by that of its part; 0 if that does not end or
// the part has more than `most` elements.
double growth_of_part(const Simulation& s, std::span<const GrownElement> part, double enough,
                      std::size_t most) {
  std::vector<std::int32_t> elements;
  for (const GrownElement& grown : part) elements.push_back(grown.element);
  const std::unique_ptr<Patch> patch = make_present_patch(s, elements, most);
  if (!patch) return 0;
  const double step = search_step(*patch, search_amplitude(s.model, s.edge_length), Communicator(),
                                  s.look.step / std::sqrt(enough));
  return step > 0 ? std::max(1.0, s.look.step * s.look.step / (step * step)) : 0;
}

// The part counts from here: as having grown by `growth`.
void follow_part(std::vector<GrownElement> part, double growth, Simulation& s) {
  for (GrownElement& grown : part) grown.stiffening /= growth;
  take_searched(s.part, part, *s.look.stiffening);
  std::vector<GrownElement>& searched = s.look.searched;
  searched.insert(searched.begin(), part.begin(), part.end());
  sort_unique_by(searched, &GrownElement::element);
}

}  // namespace

bool can_search_part(const Simulation& s) {
  return s.look.step > 0 && s.look.stiffening && !s.sleep && !s.multirate && !s.mass_scaling &&
         !is_viscous(s.materials);
}

double search_grown_part(Simulation& s, double growth) {
  s.look.asked = growth;
  constexpr double of_rest = least_growth_of_part;
  const auto most = static_cast<std::size_t>(largest_part * s.mesh.n_elements());
  const std::vector<GrownElement> part = grown_elements(s, of_rest, most);
  const double of_part = part.empty() ? 0 : growth_of_part(s, part, of_rest, most);
  if (of_part == 0) return growth;
  ++s.log.searches.n_of_parts;
  follow_part(part, of_part, s);
  s.look.growth = of_part;
  return s.look.asked = std::max(of_rest, of_part);
}

void take_searched(const Part& part, std::span<const GrownElement> searched,
                   std::vector<double>& stiffening) {
  for (const GrownElement& one : searched)
    if (const std::int64_t k = part.place_of(one.element); k >= 0) stiffening[k] = one.stiffening;
}

}  // namespace trocar
