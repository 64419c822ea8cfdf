// Every broken invariant of a mesh as a sentence.
#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "mesh/edit.h"
#include "mesh/facet_sort.h"
#include "mesh/facets.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

// The sentences so far; takes no more than `most`.
struct Report {
  std::vector<std::string> sentences;
  std::size_t most = 0;
  bool is_full() const { return sentences.size() >= most; }
  void add(std::string sentence) {
    if (!is_full()) sentences.push_back(std::move(sentence));
  }
};

std::string number(double value) {
  return short_text(value, 4);
}

std::string element_text(const Mesh& mesh, std::int32_t e) {
  return "element " + std::to_string(e) + " (" + element_type_name(mesh.element_type[e]) + ")";
}

void check_count(Report& report, const char* name, std::size_t found, std::size_t expected) {
  if (found != expected)
    report.add(std::string(name) + " has " + std::to_string(found) + " entries instead of " +
               std::to_string(expected));
}

// Whether each corner belongs to one element.
bool have_own_corners(Report& report, const Mesh& mesh) {
  std::size_t n_all = 0;
  for (const ElementType type : mesh.element_type)
    n_all += static_cast<std::size_t>(n_corners(type));
  check_count(report, "corner_node", mesh.corner_node.size(), n_all);
  if (!report.sentences.empty()) return false;
  std::vector<std::uint8_t> is_taken(n_all, 0);
  for (std::size_t e = 0; e < mesh.element_type.size(); ++e) {
    const std::int64_t first = mesh.corner_offset[e], n = n_corners(mesh.element_type[e]);
    const bool is_within = first >= 0 && first + n <= std::ssize(is_taken);
    if (!is_within || std::any_of(&is_taken[first], &is_taken[first] + n,
                                  [](auto taken) { return taken != 0; })) {
      report.add("corner_offset of element " + std::to_string(e) + " is " + std::to_string(first) +
                 (is_within ? ", where another element has corners" : ", where there are none"));
      return false;
    }
    std::fill_n(&is_taken[first], n, std::uint8_t{1});
  }
  return true;
}

// Without sound arrays nothing else can be looked at.
bool check_arrays(Report& report, const Mesh& mesh) {
  const std::size_t n = mesh.element_type.size();
  check_count(report, "corner_offset", mesh.corner_offset.size(), n);
  check_count(report, "element_region", mesh.element_region.size(), n);
  check_count(report, "density_factor", mesh.density_factor.size(), n);
  check_count(report, "cut_facets", mesh.cut_facets.size(), n);
  if (!mesh.fibre.empty()) check_count(report, "fibre", mesh.fibre.size(), n);
  if (!report.sentences.empty()) return false;
  return have_own_corners(report, mesh);
}

bool is_corner_list_sound(Report& report, const Mesh& mesh, std::int32_t e) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  for (std::size_t a = 0; a < node.size(); ++a) {
    if (node[a] < 0 || node[a] >= mesh.n_nodes()) {
      report.add(element_text(mesh, e) + " has corner " + std::to_string(node[a]) +
                 ", but the nodes run from 0 to " + std::to_string(mesh.n_nodes() - 1));
      return false;
    }
    if (std::find(node.begin(), node.begin() + static_cast<std::ptrdiff_t>(a), node[a]) !=
        node.begin() + static_cast<std::ptrdiff_t>(a)) {
      report.add(element_text(mesh, e) + " has node " + std::to_string(node[a]) +
                 " at two corners:" + nodes_text(node));
      return false;
    }
  }
  return true;
}

bool is_finite(const Mesh& mesh, std::span<const std::int32_t> node) {
  return std::all_of(node.begin(), node.end(),
                     [&](std::int32_t i) { return mesh.X[i].allFinite(); });
}

void check_volume(Report& report, const Mesh& mesh, std::int32_t e) {
  if (!is_finite(mesh, mesh.corners(e))) return;  // reported by its node
  const double V = element_volume(mesh, e, mesh.X);
  if (V > 0) return;
  const bool is_plane = mesh.element_type[e] == ElementType::tri3;
  report.add(element_text(mesh, e) + (V < 0 ? " is inverted: " : " is flat: ") +
             (is_plane ? "area " : "volume ") + number(V) + (is_plane ? " m^2" : " m^3") +
             ", corners" + nodes_text(mesh.corners(e)));
}

void check_element_values(Report& report, const Mesh& mesh, std::int32_t e) {
  const auto n_regions = static_cast<std::int32_t>(mesh.region_name.size());
  if (mesh.element_region[e] < 0 || mesh.element_region[e] >= n_regions)
    report.add(element_text(mesh, e) + " has region " + std::to_string(mesh.element_region[e]) +
               ", but there are " + std::to_string(n_regions));
  if (!(mesh.density_factor[e] > 0) || !std::isfinite(mesh.density_factor[e]))
    report.add(element_text(mesh, e) + " has density factor " + number(mesh.density_factor[e]) +
               ", which must be positive");
  if (!mesh.fibre.empty() && !(std::abs(mesh.fibre[e].dot(mesh.fibre[e]) - 1) < 1e-6))
    report.add(element_text(mesh, e) + " has a fibre direction that is not a unit vector");
}

// False if the corners of some element can't be followed.
bool check_elements(Report& report, const Mesh& mesh) {
  bool is_sound = true;
  const bool is_plane = mesh.dimension() == 2;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    check_element_values(report, mesh, e);
    if (!is_plane && mesh.element_type[e] == ElementType::tri3)
      report.add(element_text(mesh, e) + " is a triangle among volume elements");
    if (is_corner_list_sound(report, mesh, e))
      check_volume(report, mesh, e);
    else
      is_sound = false;
  }
  return is_sound;
}

// Tetrahedra have the places that the splits gave them.
void check_split_hexahedra(Report& report, const Mesh& mesh) {
  std::int64_t end = 0;  // of the parts of the one before
  const auto is_tet = [&](std::int64_t e) { return mesh.element_type[e] == ElementType::tet4; };
  for (const auto& [element, first] : mesh.split_hexahedra) {
    const bool is_after = first >= end && element >= 0 && element < first;
    end = std::int64_t{first} + n_hex_tets - 1;
    bool is_sound = is_after && end <= mesh.n_elements() && is_tet(element);
    for (std::int64_t e = first; is_sound && e < end; ++e) is_sound = is_tet(e);
    if (is_sound) continue;
    report.add("hexahedron " + std::to_string(element) +
               " is said to be split, but its tetrahedra are not where they should be");
    return;
  }
}

void check_nodes(Report& report, const Mesh& mesh) {
  std::vector<std::uint8_t> is_used(mesh.X.size(), 0);
  for (const std::int32_t i : mesh.corner_node)
    if (i >= 0 && i < mesh.n_nodes()) is_used[i] = 1;
  const bool is_plane = mesh.dimension() == 2;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3& X = mesh.X[i];
    const std::string name = "node " + std::to_string(i);
    if (!X.allFinite())
      report.add(name + " is not finite: (" + number(X.x()) + ", " + number(X.y()) + ", " +
                 number(X.z()) + ")");
    else if (is_plane && X.z() != 0)
      report.add(name + " of a plane mesh has z = " + number(X.z()) + " m instead of 0");
    if (is_used[i] == 0) report.add(name + " belongs to no element");
  }
}

void check_node_sets(Report& report, const Mesh& mesh) {
  for (const NodeSet& set : mesh.node_sets) {
    for (const std::int32_t i : set.node)
      if (i < 0 || i >= mesh.n_nodes())
        report.add("node set \"" + set.name + "\" holds node " + std::to_string(i) +
                   ", but the nodes run from 0 to " + std::to_string(mesh.n_nodes() - 1));
    for (const FacetNodes& facet : set.left_out)
      if (facet.front() < -1 || facet.back() >= mesh.n_nodes())
        report.add("node set \"" + set.name + "\" leaves out a facet with node " +
                   std::to_string(facet.back()) + ", but the nodes run from 0 to " +
                   std::to_string(mesh.n_nodes() - 1));
    const auto falls = [](std::int32_t i, std::int32_t j) { return i >= j; };
    if (std::adjacent_find(set.node.begin(), set.node.end(), falls) != set.node.end())
      report.add("node set \"" + set.name + "\" is not strictly ascending");
  }
}

bool has_same_corners(const Mesh& mesh, std::int32_t e, std::int32_t f) {
  const std::span<const std::int32_t> a = mesh.corners(e), b = mesh.corners(f);
  return std::is_permutation(a.begin(), a.end(), b.begin(), b.end());
}

// The facet's nodes, outward; of a face from the lowest on.
std::vector<std::int32_t> outward_nodes(const Mesh& mesh, const FacetSide& side) {
  std::vector<std::int32_t> node;
  for (const int corner : facet_corners(mesh.element_type[side.element], side.facet))
    if (corner >= 0) node.push_back(mesh.corners(side.element)[corner]);
  if (node.size() > 2)
    std::rotate(node.begin(), std::min_element(node.begin(), node.end()), node.end());
  return node;
}

// Both volumes are positive: across a facet its nodes run the other way round. A duplicate is
// reported as that.
void check_sides(Report& report, const Mesh& mesh, const FacetSide& a, const FacetSide& b) {
  const std::vector<std::int32_t> node = outward_nodes(mesh, a);
  if (node != outward_nodes(mesh, b) || has_same_corners(mesh, a.element, b.element)) return;
  Vec3 place = Vec3::Zero();
  for (const std::int32_t i : node) place += mesh.X[i] / static_cast<double>(node.size());
  report.add("elements " + std::to_string(a.element) + " and " + std::to_string(b.element) +
             " overlap: both lie on one side of the facet of nodes" + nodes_text(a.node) +
             ", at (" + number(place.x()) + ", " + number(place.y()) + ", " + number(place.z()) +
             ") m");
}

void check_facets(Report& report, const Mesh& mesh) {
  for_each_facet(mesh, [&](std::span<const FacetSide> side) {
    if (report.is_full()) return;
    if (side.size() == 2) check_sides(report, mesh, side[0], side[1]);
    if (side.size() <= 2) return;
    std::string elements;
    for (const FacetSide& s : side.first(std::min<std::size_t>(side.size(), 6)))
      elements += (elements.empty() ? "" : ", ") + std::to_string(s.element);
    report.add("the facet of nodes" + nodes_text(side[0].node) + " is shared by " +
               std::to_string(side.size()) + " elements: " + elements);
  });
}

void check_duplicates(Report& report, const Mesh& mesh) {
  using Sorted = std::pair<std::array<std::int32_t, max_corners>, std::int32_t>;
  std::vector<Sorted> element;
  element.reserve(mesh.element_type.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    Sorted sorted{{}, e};
    sorted.first.fill(-1);
    const std::span<const std::int32_t> node = mesh.corners(e);
    std::copy(node.begin(), node.end(), sorted.first.begin());
    std::sort(sorted.first.begin(), sorted.first.end());
    element.push_back(sorted);
  }
  std::sort(element.begin(), element.end());
  const auto is_same = [](const Sorted& a, const Sorted& b) { return a.first == b.first; };
  const auto first = std::adjacent_find(element.begin(), element.end(), is_same);
  if (first == element.end()) return;
  int n_more = 0;
  for (auto next = first + 2; next != element.end(); ++next) n_more += is_same(next[-1], next[0]);
  std::string sentence = "elements " + std::to_string(first[0].second) + " and " +
                         std::to_string(first[1].second) +
                         " have the same corners:" + nodes_text(first->first);
  if (n_more > 0)
    sentence += "; so have " + std::to_string(n_more) +
                " more: a file of MSH 2 names an element of two physical groups once for each";
  report.add(sentence);
}

}  // namespace

std::vector<std::string> validate(const Mesh& mesh, int most) {
  Report report;
  report.most = static_cast<std::size_t>(std::max(most, 1));
  if (!check_arrays(report, mesh)) return report.sentences;
  if (mesh.n_elements() == 0) report.add("the mesh has no elements");
  const bool is_sound = check_elements(report, mesh);
  check_split_hexahedra(report, mesh);
  check_nodes(report, mesh);
  check_node_sets(report, mesh);
  if (!is_sound || report.is_full()) return report.sentences;
  check_duplicates(report, mesh);
  check_facets(report, mesh);
  return report.sentences;
}

}  // namespace trocar
