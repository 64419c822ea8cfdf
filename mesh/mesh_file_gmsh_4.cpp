// Entities, nodes and elements of gmsh format 4.1, ASCII and binary alike.
#include <algorithm>
#include <limits>
#include <utility>

#include "mesh/mesh_file_gmsh.h"

namespace trocar {

static std::int32_t entity_tag(GmshReader& g) {
  const std::int64_t tag = gmsh_int(g, "an entity");
  if (tag < std::numeric_limits<std::int32_t>::min() ||
      tag > std::numeric_limits<std::int32_t>::max())
    g.in.fail("entity " + std::to_string(tag) + " is beyond 32 bits");
  return static_cast<std::int32_t>(tag);
}

static void read_entity(GmshReader& g, int dimension) {
  GmshEntity entity{.dimension = dimension, .tag = entity_tag(g)};
  const int n_bounds = dimension == 0 ? 3 : 6;
  for (int k = 0; k < n_bounds; ++k) gmsh_real(g, "a bound of an entity");
  const std::size_t n_physical =
      g.in.check_count(gmsh_size(g, "the number of physical groups"), 2, "physical groups");
  for (std::size_t k = 0; k < n_physical; ++k) g.mesh.group_tag.push_back(gmsh_physical_tag(g));
  if (n_physical > 0) {
    if (g.mesh.group_tag.size() > std::numeric_limits<std::int32_t>::max())
      g.in.fail("the entities have more than 2147483647 physical groups in all");
    entity.group_list = static_cast<std::int32_t>(g.mesh.group_offset.size() - 1);
    g.mesh.group_offset.push_back(static_cast<std::int32_t>(g.mesh.group_tag.size()));
  }
  g.entities.push_back(entity);
  if (dimension == 0) return;
  const std::size_t n_boundary =
      g.in.check_count(gmsh_size(g, "the number of boundary entities"), 2, "boundary entities");
  for (std::size_t k = 0; k < n_boundary; ++k) gmsh_int(g, "a boundary entity");
}

static auto key_of(const GmshEntity& entity) {
  return std::pair(entity.dimension, entity.tag);
}

void read_entities_4(GmshReader& g) {
  if (g.has_elements || !g.entities.empty()) g.in.fail("$Entities stands here too late or again");
  begin_data(g);
  std::array<std::size_t, 4> n{};
  for (std::size_t& count : n)
    count = g.in.check_count(gmsh_size(g, "the number of entities"), 10, "entities");
  for (int d = 0; d < 4; ++d)
    for (std::size_t k = 0; k < n[d]; ++k) read_entity(g, d);
  std::ranges::sort(g.entities, {}, key_of);
  end_section(g, "$EndEntities");
}

// Groups of an entity; a file without $Entities has no groups.
static std::int32_t group_list(const GmshReader& g, int dimension, std::int32_t tag) {
  const std::pair wanted(dimension, tag);
  const auto found = std::ranges::lower_bound(g.entities, wanted, {}, key_of);
  const bool is_found = found != g.entities.end() && key_of(*found) == wanted;
  return is_found ? found->group_list : 0;
}

// Head of the section: blocks and things in all. The least and greatest tag are of no use.
struct Head {
  std::size_t n_blocks = 0, n = 0;
};

static Head read_head(GmshReader& g, std::size_t n_bytes_each, const char* what) {
  begin_data(g);
  Head head;
  head.n_blocks = g.in.check_count(gmsh_size(g, "the number of blocks"), 8, "blocks");
  head.n = g.in.check_count(gmsh_size(g, "a number of things"), n_bytes_each, what);
  gmsh_size(g, "the least tag");
  gmsh_size(g, "the greatest tag");
  return head;
}

static int block_dimension(GmshReader& g) {
  const std::int64_t dimension = gmsh_int(g, "the dimension of a block");
  if (dimension < 0 || dimension > 3)
    g.in.fail("the dimension of a block is " + std::to_string(dimension));
  return static_cast<int>(dimension);
}

static std::size_t block_size(GmshReader& g, std::size_t n_left, const char* what) {
  const std::int64_t n = gmsh_size(g, "the size of a block");
  if (n < 0 || static_cast<std::uint64_t>(n) > n_left)
    g.in.fail("a block of " + std::to_string(n) + " " + what + ", but only " +
              std::to_string(n_left) + " are left of the announced number");
  return static_cast<std::size_t>(n);
}

static void check_all_read(const GmshReader& g, std::size_t n, std::size_t n_read,
                           const char* what) {
  if (n != n_read)
    g.in.fail(std::to_string(n) + " " + what + " are announced, but the blocks hold " +
              std::to_string(n_read));
}

void read_nodes_4(GmshReader& g) {
  const Head head = read_head(g, g.is_binary ? 32 : 8, "nodes");
  g.mesh.node_tag.reserve(head.n);
  g.mesh.X.reserve(head.n);
  for (std::size_t b = 0; b < head.n_blocks; ++b) {
    const int dimension = block_dimension(g);
    entity_tag(g);
    const std::int64_t parametric = gmsh_int(g, "the parametric mark");
    if (parametric != 0 && parametric != 1)
      g.in.fail("the parametric mark is " + std::to_string(parametric) + ", not 0 or 1");
    const std::size_t n = block_size(g, head.n - g.mesh.X.size(), "nodes");
    for (std::size_t i = 0; i < n; ++i) g.mesh.node_tag.push_back(gmsh_size(g, "a node tag"));
    const int n_parameters = parametric == 1 ? dimension : 0;
    for (std::size_t i = 0; i < n; ++i) {
      g.mesh.X.push_back(gmsh_point(g));
      for (int k = 0; k < n_parameters; ++k) gmsh_real(g, "a parameter of a node");
    }
  }
  check_all_read(g, head.n, g.mesh.X.size(), "nodes");
  end_section(g, "$EndNodes");
  finish_nodes(g);
}

static void read_element(GmshReader& g, CellKind kind, std::int32_t groups) {
  const std::int64_t tag = gmsh_size(g, "an element tag");
  read_gmsh_corners(g, kind, tag, groups, gmsh_size);
}

// The first element stands for a block of a kind that is not supported: its tag comes next.
static CellKind block_kind(GmshReader& g, std::int64_t type, std::size_t n) {
  const bool is_supported = (type >= 1 && type <= 5) || type == 15;
  const std::int64_t first = is_supported || n == 0 ? 0 : gmsh_size(g, "an element tag");
  return gmsh_cell_kind(g, type, first);
}

void read_elements_4(GmshReader& g) {
  const Head head = read_head(g, g.is_binary ? 16 : 4, "elements");
  reserve_cells(g.mesh, head.n);
  for (std::size_t b = 0; b < head.n_blocks; ++b) {
    const int dimension = block_dimension(g);
    const std::int32_t groups = group_list(g, dimension, entity_tag(g));
    const std::int64_t type = gmsh_int(g, "an element type");
    const std::size_t n = block_size(g, head.n - g.mesh.cell_kind.size(), "elements");
    const CellKind kind = block_kind(g, type, n);
    if (cell_dimension(kind) != dimension)
      g.in.fail(std::string("a block of ") + cell_kind_name(kind) + "s has dimension " +
                std::to_string(dimension));
    for (std::size_t e = 0; e < n; ++e) read_element(g, kind, groups);
  }
  check_all_read(g, head.n, g.mesh.cell_kind.size(), "elements");
  end_section(g, "$EndElements");
}

}  // namespace trocar
