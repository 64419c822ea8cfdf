// Nodes and elements of gmsh formats 1.0 and 2.x.
#include "mesh/mesh_file_gmsh.h"

namespace trocar {

void read_nodes_2(GmshReader& g, std::string_view end) {
  const std::int64_t count = g.in.integer("the number of nodes");
  begin_data(g);
  const std::size_t n = g.in.check_count(count, g.in.is_binary ? 28 : 8, "nodes");
  g.mesh.X.reserve(n);
  g.mesh.node_tag.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    g.mesh.node_tag.push_back(gmsh_int(g, "a node number"));
    g.mesh.X.push_back(gmsh_point(g));
  }
  end_section(g, end);
  finish_nodes(g);
}

void read_elements_1(GmshReader& g) {
  const std::size_t n = g.in.check_count(g.in.integer("the number of elements"), 12, "elements");
  reserve_cells(g.mesh, n);
  for (std::size_t e = 0; e < n; ++e) {
    const std::int64_t tag = g.in.integer("an element number");
    const CellKind kind = gmsh_cell_kind(g, g.in.integer("an element type"), tag);
    const std::int32_t physical = gmsh_physical_tag(g);
    g.in.integer("an elementary entity");
    const std::int64_t n_corners = g.in.integer("the number of corners");
    if (n_corners != n_cell_corners(kind))
      g.in.fail("element " + std::to_string(tag) + " is a " + cell_kind_name(kind) + " with " +
                std::to_string(n_corners) + " corners");
    read_gmsh_corners(g, kind, tag, physical, gmsh_int);
  }
  g.in.expect_word("$ENDELM");
  make_group_lists(g.mesh);
}

// The first tag is the physical group, the second the geometric entity, what follows partitions.
static std::int32_t read_tags(GmshReader& g, std::int64_t n_tags) {
  std::int32_t physical = 0;
  for (std::int64_t k = 0; k < n_tags; ++k) {
    if (k == 0)
      physical = gmsh_physical_tag(g);
    else
      gmsh_int(g, "a tag");
  }
  return physical;
}

static void read_text_elements(GmshReader& g, std::size_t n) {
  for (std::size_t e = 0; e < n; ++e) {
    const std::int64_t tag = g.in.integer("an element number");
    const CellKind kind = gmsh_cell_kind(g, g.in.integer("an element type"), tag);
    const std::int64_t n_tags = g.in.integer("the number of tags");
    g.in.check_count(n_tags, 2, "tags of an element");
    read_gmsh_corners(g, kind, tag, read_tags(g, n_tags), gmsh_int);
  }
}

// In blocks of elements of one type and number of tags.
static void read_binary_elements(GmshReader& g, std::size_t n) {
  for (std::size_t n_read = 0; n_read < n;) {
    const std::int64_t type = gmsh_int(g, "an element type");
    const std::int64_t n_block = gmsh_int(g, "the number of elements of a block");
    const std::int64_t n_tags = gmsh_int(g, "the number of tags");
    g.in.check_count(n_tags, 4, "tags of an element");
    if (n_block < 1 || static_cast<std::size_t>(n_block) > n - n_read)
      g.in.fail("a block of " + std::to_string(n_block) + " elements, but " +
                std::to_string(n - n_read) + " are missing");
    for (std::int64_t e = 0; e < n_block; ++e, ++n_read) {
      const std::int64_t tag = gmsh_int(g, "an element number");
      const CellKind kind = gmsh_cell_kind(g, type, tag);
      read_gmsh_corners(g, kind, tag, read_tags(g, n_tags), gmsh_int);
    }
  }
}

void read_elements_2(GmshReader& g) {
  const std::int64_t count = g.in.integer("the number of elements");
  begin_data(g);
  const std::size_t n = g.in.check_count(count, 8, "elements");
  reserve_cells(g.mesh, n);
  if (g.in.is_binary)
    read_binary_elements(g, n);
  else
    read_text_elements(g, n);
  end_section(g, "$EndElements");
  make_group_lists(g.mesh);
}

}  // namespace trocar
