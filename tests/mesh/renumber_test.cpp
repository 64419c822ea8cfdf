// A mesh in another order is the same mesh.
#include "mesh/renumber.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "mesh/generate.h"
#include "mesh/quality.h"
#include "mesh_equal.h"

namespace trocar {
namespace {

// Of every third element the facet at z = 0 if it has one.
std::vector<FacetNodes> some_low_facets(const Mesh& mesh) {
  std::vector<FacetNodes> facets;
  for (std::int32_t e = 0; e < mesh.n_elements(); e += 3) {
    std::vector<std::int32_t> low;
    for (const std::int32_t i : mesh.corners(e))
      if (mesh.X[i].z() == 0) low.push_back(i);
    if (low.size() < (mesh.element_type[e] == ElementType::hex8 ? 4U : 3U)) continue;
    FacetNodes& facet = facets.emplace_back(FacetNodes{-1, -1, -1, -1});
    std::copy_backward(low.begin(), low.end(), facet.end());
    std::ranges::sort(facet);
  }
  std::ranges::sort(facets);
  return facets;
}

// Two regions with fibres of their own, a node set, and numbers that differ from element to
// element.
Mesh body(BoxElements elements) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(3, 2, 1), {9, 6, 4}, elements);
  mesh.region_name = {"soft", "stiff"};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    mesh.element_region[e] = mesh.X[mesh.corners(e)[0]].x() > 1.5 ? 1 : 0;
    mesh.density_factor[e] = 1 + 1e-3 * e;
    mesh.cut_facets[e] = static_cast<std::uint8_t>(e % 16);
    mesh.fibre.push_back(Vec3(1, e, 0).normalized());
  }
  NodeSet low{"low", {}};
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.X[i].z() == 0) low.node.push_back(i);
  low.left_out = some_low_facets(mesh);
  mesh.node_sets = {low};
  return mesh;
}

// The same body as a mesher may write it: nodes and elements in any order.
Mesh shuffled(const Mesh& mesh) {
  std::mt19937 random(7);
  std::vector<std::int32_t> number(mesh.X.size()), order(mesh.element_type.size());
  std::iota(number.begin(), number.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  std::shuffle(order.begin(), order.end(), random);
  Mesh result = mesh;
  for (std::size_t i = 0; i < number.size(); ++i) result.X[number[i]] = mesh.X[i];
  result.corner_node.clear();
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::int32_t e = order[k];
    for (const std::int32_t i : mesh.corners(e)) result.corner_node.push_back(number[i]);
    result.element_region[k] = mesh.element_region[e];
    result.density_factor[k] = mesh.density_factor[e];
    result.cut_facets[k] = mesh.cut_facets[e];
    result.fibre[k] = mesh.fibre[e];
  }
  for (std::int32_t& i : result.node_sets[0].node) i = number[i];
  std::sort(result.node_sets[0].node.begin(), result.node_sets[0].node.end());
  for (FacetNodes& facet : result.node_sets[0].left_out) {
    for (std::int32_t& i : facet) i = i < 0 ? i : number[i];
    std::ranges::sort(facet);
  }
  std::ranges::sort(result.node_sets[0].left_out);
  return result;
}

// All of an element, by its own numbers, which differ from element to element.
std::map<double, std::vector<double>> elements_of(const Mesh& mesh) {
  std::map<double, std::vector<double>> elements;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    std::vector<double>& x = elements[mesh.density_factor[e]];
    x = {double(mesh.element_region[e]), double(mesh.cut_facets[e]), mesh.fibre[e].x(),
         mesh.fibre[e].y()};
    for (const std::int32_t i : mesh.corners(e))
      x.insert(x.end(), {mesh.X[i].x(), mesh.X[i].y(), mesh.X[i].z()});
  }
  return elements;
}

// Where the nodes of each facet are that the node set leaves out.
std::set<std::set<std::array<double, 3>>> left_out_places(const Mesh& mesh) {
  std::set<std::set<std::array<double, 3>>> facets;
  for (const FacetNodes& facet : mesh.node_sets[0].left_out) {
    std::set<std::array<double, 3>> places;
    for (const std::int32_t i : facet)
      if (i >= 0) places.insert({mesh.X[i].x(), mesh.X[i].y(), mesh.X[i].z()});
    facets.insert(places);
  }
  return facets;
}

TEST(Renumber, leaves_the_body_what_it_is) {
  for (const BoxElements elements : {BoxElements::tet4_five, BoxElements::hex8}) {
    const Mesh mesh = shuffled(body(elements)), near = renumbered(mesh);
    EXPECT_EQ(elements_of(near), elements_of(mesh));
    EXPECT_TRUE(validate(near).empty());
    EXPECT_EQ(near.region_name, mesh.region_name);
    ASSERT_EQ(near.node_sets.size(), 1U);
    EXPECT_EQ(near.node_sets[0].node.size(), mesh.node_sets[0].node.size());
    for (const std::int32_t i : near.node_sets[0].node) EXPECT_EQ(near.X[i].z(), 0);
    EXPECT_TRUE(std::ranges::is_sorted(near.node_sets[0].node));
    EXPECT_GT(mesh.node_sets[0].left_out.size(), 10U);
    EXPECT_EQ(left_out_places(near), left_out_places(mesh));
    EXPECT_TRUE(std::ranges::is_sorted(near.node_sets[0].left_out));
    for (const FacetNodes& facet : near.node_sets[0].left_out)
      EXPECT_TRUE(std::ranges::is_sorted(facet));
  }
}

// A layer of the box across its longest side has 7 x 5 nodes; nobody's nodes need be further apart
// than two layers, and the elements come as their nodes do.
TEST(Renumber, brings_the_nodes_of_an_element_together) {
  const Mesh mesh = shuffled(body(BoxElements::tet4_five)), near = renumbered(mesh);
  EXPECT_GT(mean_node_span(mesh), 150);
  EXPECT_LT(mean_node_span(near), 70);
  for (std::int32_t e = 1; e < near.n_elements(); ++e)
    EXPECT_LE(std::ranges::min(near.corners(e - 1)), std::ranges::min(near.corners(e)));
  test::expect_equal(in_near_order(mesh), interleaved(near));
}

TEST(Renumber, keeps_an_order_that_is_good) {
  const Mesh mesh = body(BoxElements::hex8), near = renumbered(shuffled(mesh));
  test::expect_equal(in_near_order(mesh), mesh);
  test::expect_equal(in_near_order(near), near);
}

// Of the nodes that 16 elements have one behind the other, those that another one has had.
double mean_of_repeated_nodes(const Mesh& mesh) {
  constexpr std::int32_t n = 16;
  std::int64_t repeated = 0;
  for (std::int32_t first = 0; first + n <= mesh.n_elements(); first += n) {
    std::set<std::int32_t> seen;
    for (std::int32_t e = first; e < first + n; ++e)
      for (const std::int32_t i : mesh.corners(e)) repeated += seen.insert(i).second ? 0 : 1;
  }
  return static_cast<double>(repeated) / (mesh.n_elements() / n);
}

TEST(Renumber, interleaves_tetrahedra_that_share_nodes) {
  const Mesh mesh = body(BoxElements::tet4_five), result = interleaved(mesh);
  EXPECT_EQ(elements_of(result), elements_of(mesh));
  EXPECT_GT(mean_of_repeated_nodes(mesh), 40);
  EXPECT_LT(mean_of_repeated_nodes(result), 25);
  const Mesh hexahedra = body(BoxElements::hex8);
  test::expect_equal(interleaved(hexahedra), hexahedra);
}

TEST(Renumber, takes_pieces_one_after_the_other) {
  Mesh mesh = body(BoxElements::tet4_kuhn);
  const std::int32_t n = mesh.n_nodes();
  const Mesh one = mesh;
  for (const Vec3& X : one.X) mesh.X.push_back(X + Vec3(10, 0, 0));
  for (std::int32_t e = 0; e < one.n_elements(); ++e) {
    std::array<std::int32_t, 4> corner{};
    for (int a = 0; a < 4; ++a) corner[std::size_t(a)] = one.corners(e)[std::size_t(a)] + n;
    add_element(mesh, ElementType::tet4, corner);
    mesh.fibre.emplace_back(1, 0, 0);
  }
  const Mesh near = renumbered(mesh);
  for (std::int32_t i = 0; i < 2 * n; ++i)
    EXPECT_EQ(near.X[std::size_t(i)].x() < 5, (near.X[0].x() < 5) == (i < n));
}

}  // namespace
}  // namespace trocar
