#include "collision/contact_set.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "base/sort_unique.h"

namespace trocar {

namespace {

// Each rank with nodes tells all others of them: they are few.
Halo all_to_all(const ContactSet& set, std::span<const std::int32_t> node_owner, int rank) {
  std::vector<int> ranks;
  for (const std::int32_t i : set.node) ranks.push_back(node_owner[i]);
  sort_unique(ranks);
  Halo halo;
  for (const int other : ranks) {
    if (other == rank) continue;
    halo.neighbours.push_back({.rank = other, .send = set.owned});
    for (std::size_t place = 0; place < set.node.size(); ++place)
      if (node_owner[set.node[place]] == other)
        halo.neighbours.back().receive.push_back(static_cast<std::int32_t>(place));
  }
  return halo;
}

std::vector<std::int32_t> nodes_of(const FoundContacts& contacts) {
  std::vector<std::int32_t> node;
  for (const Contact& contact : contacts.with_tools)
    node.insert(node.end(), contact.node.begin(), contact.node.end());
  for (const TissuePair& pair : contacts.with_tissue) {
    node.push_back(pair.node);
    node.insert(node.end(), pair.corner.begin(), pair.corner.end());
  }
  sort_unique(node);
  return node;
}

std::int32_t place_of(const ContactSet& set, std::int32_t node) {
  return place_in(set.node, node);
}

// The detector has a piece's contacts one behind the other.
void add_beside(ContactSet& set) {
  std::vector<std::int32_t> last(set.node.size(), -1);  // entry of each node
  std::int32_t first = 0;                               // entry of the present piece
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    ContactSet::Item& item = set.items[k];
    const Contact &contact = item.contact, &before = set.items[k > 0 ? k - 1 : 0].contact;
    if (contact.tool != before.tool || contact.piece != before.piece)
      first = static_cast<std::int32_t>(set.beside.size());
    for (std::size_t a = 0; a < 3; ++a) {
      std::int32_t& entry = last[item.place[a]];
      if (entry < first) {
        entry = static_cast<std::int32_t>(set.beside.size());
        set.beside.push_back({.item = static_cast<std::int32_t>(k), .place = item.place[a]});
      }
      item.beside[a] = entry;
    }
  }
}

void add_items(const FoundContacts& contacts, ContactSet& set) {
  for (const Contact& contact : contacts.with_tools) {
    ContactSet::Item& item = set.items.emplace_back();
    item.contact = contact;
    for (std::size_t a = 0; a < 3; ++a) item.place[a] = place_of(set, contact.node[a]);
  }
  add_beside(set);
  for (const TissuePair& pair : contacts.with_tissue) {
    const std::size_t k = set.tissue.size();
    if (k == 0 || contacts.with_tissue[k - 1].node != pair.node)
      set.tissue_node.push_back({.first = k});
    set.tissue_node.back().end = k + 1;
    set.tissue.push_back({.place = {place_of(set, pair.node), place_of(set, pair.corner[0]),
                                    place_of(set, pair.corner[1]), place_of(set, pair.corner[2])},
                          .handicap = pair.handicap});
  }
}

// The first of the ranks with nodes at tools: other pairs of tissue leave it as it is.
bool counts_reactions(const FoundContacts& contacts, std::span<const std::int32_t> node_owner,
                      int rank) {
  std::int32_t first = std::numeric_limits<std::int32_t>::max();
  for (const Contact& contact : contacts.with_tools)
    for (const std::int32_t i : contact.node) first = std::min(first, node_owner[i]);
  return first == rank;
}

Vec3 inverse_mass(double mass, unsigned held) {
  Vec3 by_mass;
  for (int j = 0; j < 3; ++j) by_mass[j] = (held >> j & 1U) != 0 ? 0 : 1 / mass;
  return by_mass;
}

// Completes the inverse masses, which are those of nodes alone so far.
void add_clusters(const ContactInertia& inertia, ContactSet& set) {
  ContactClusters& clusters = set.clusters;
  clusters.yield.assign(inertia.yield.begin(), inertia.yield.end());
  clusters.impulse.resize(inertia.yield.size());
  clusters.alone = set.inverse_mass;
  for (std::size_t k = 0; k < set.node.size(); ++k) {
    const std::int32_t i = set.node[k], c = inertia.cluster[i];
    clusters.of.push_back(c);
    clusters.share.push_back(Vec3::Zero());
    if (c < 0) continue;
    Vec3& share = clusters.share.back();
    for (int j = 0; j < 3; ++j)
      if (clusters.alone[k][j] != 0) share[j] = inertia.share[i];
    set.inverse_mass[k] += share.cwiseProduct(share).cwiseProduct(clusters.yield[c]);
  }
}

}  // namespace

ContactSet prepare_contacts(const FoundContacts& contacts, std::span<const std::int32_t> node_owner,
                            const Part& part, const ContactInertia& inertia) {
  ContactSet set{.node = nodes_of(contacts)};
  for (const std::int32_t i : set.node) {
    if (node_owner[i] == part.rank) {
      set.owned.push_back(static_cast<std::int32_t>(set.inverse_mass.size()));
      set.local.push_back(part.node_local[i]);
    }
    set.inverse_mass.push_back(inverse_mass(inertia.mass[i], inertia.held[i]));
  }
  if (set.owned.empty()) return {};
  if (!inertia.cluster.empty()) add_clusters(inertia, set);
  add_items(contacts, set);
  set.x_start.resize(set.node.size());
  set.x_end.resize(set.node.size());
  set.force.assign(set.node.size(), Vec3::Zero());
  set.constraints.reserve((1 + Manifold::most_points) * set.items.size() + 2 * set.node.size());
  set.deepest.resize(set.node.size());
  set.impulse.resize(set.node.size());
  set.found_by.assign(set.node.size(), -1);
  set.move.resize(set.node.size());
  set.halo = all_to_all(set, node_owner, part.rank);
  set.is_counted_here = counts_reactions(contacts, node_owner, part.rank);
  return set;
}

}  // namespace trocar
