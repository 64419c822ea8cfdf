// The gmsh reader: header, sections in any order, and what all versions share.
#include "mesh/mesh_file_gmsh.h"

#include <charconv>
#include <cmath>
#include <limits>

#include "base/quoted.h"
#include "mesh/mesh_file_formats.h"

namespace trocar {

void begin_data(GmshReader& g) {
  if (g.is_binary) g.in.begin_binary(false);
}

void end_section(GmshReader& g, std::string_view end) {
  g.in.is_binary = false;
  g.in.expect_word(end);
}

std::int64_t gmsh_int(GmshReader& g, const char* what) {
  return g.in.is_binary ? g.in.raw<std::int32_t>(what) : g.in.integer(what);
}

std::int64_t gmsh_size(GmshReader& g, const char* what) {
  return g.in.is_binary ? g.in.raw<std::int64_t>(what) : g.in.integer(what);
}

double gmsh_real(GmshReader& g, const char* what) {
  if (!g.in.is_binary) return g.in.real(what);
  const double value = g.in.raw<double>(what);
  if (!std::isfinite(value)) g.in.fail(std::string(what) + " is not finite");
  return value;
}

Vec3 gmsh_point(GmshReader& g) {
  const double x = gmsh_real(g, "x"), y = gmsh_real(g, "y"), z = gmsh_real(g, "z");
  return {x, y, z};
}

std::int32_t gmsh_physical_tag(GmshReader& g) {
  const std::int64_t tag = gmsh_int(g, "a physical group");
  constexpr std::int64_t limit = std::numeric_limits<std::int32_t>::max();
  if (tag < -limit || tag > limit)
    g.in.fail("physical group " + std::to_string(tag) + " is beyond 32 bits");
  return static_cast<std::int32_t>(std::abs(tag));
}

static std::string unsupported_name(std::int64_t type) {
  if (type == 6) return "a prism";
  if (type == 7) return "a pyramid";
  const bool is_second_order = (type >= 8 && type <= 14) || (type >= 16 && type <= 19);
  return is_second_order ? "of second order" : "of an unknown kind";
}

CellKind gmsh_cell_kind(const GmshReader& g, std::int64_t type, std::int64_t element) {
  switch (type) {
    case 15:
      return CellKind::point;
    case 1:
      return CellKind::line;
    case 2:
      return CellKind::triangle;
    case 3:
      return CellKind::quadrangle;
    case 4:
      return CellKind::tetrahedron;
    case 5:
      return CellKind::hexahedron;
    default:
      g.in.fail("element " + std::to_string(element) + " is " + unsupported_name(type) +
                " (gmsh type " + std::to_string(type) +
                "); triangles, tetrahedra and hexahedra of first order are read (types 2, 4, 5)");
  }
}

static std::int32_t gmsh_node(const GmshReader& g, std::int64_t tag, std::int64_t element) {
  const std::int32_t i = g.node_of->find(tag);
  if (i < 0)
    g.in.fail("element " + std::to_string(element) + " refers to node " + std::to_string(tag) +
              ", which the file doesn't have");
  return i;
}

void read_gmsh_corners(GmshReader& g, CellKind kind, std::int64_t tag, std::int32_t group,
                       std::int64_t (*read)(GmshReader&, const char* what)) {
  std::array<std::int32_t, max_corners> corner{};
  const auto n = static_cast<std::size_t>(n_cell_corners(kind));
  for (std::size_t a = 0; a < n; ++a)
    corner[a] = gmsh_node(g, read(g, "a corner of an element"), tag);
  add_cell(g.mesh, kind, std::span(corner.data(), n), tag, group);
}

void finish_nodes(GmshReader& g) {
  if (g.mesh.X.empty()) g.in.fail_file("holds no nodes");
  if (g.mesh.X.size() > std::numeric_limits<std::int32_t>::max())
    g.in.fail_file("has more than 2147483647 nodes");
  g.node_of.emplace(g.mesh.node_tag);
  if (const std::int32_t i = g.node_of->duplicate(); i >= 0)
    g.in.fail_file("node " + std::to_string(g.mesh.node_tag[i]) + " is listed twice");
}

namespace {

void read_byte_order(GmshReader& g) {
  begin_data(g);
  const std::int32_t one = g.in.raw<std::int32_t>("the byte order mark");
  if (one == 0x01000000)
    g.in.fail("the file was written on a machine with the other byte order; save it as ASCII");
  if (one != 1) g.in.fail("the byte order mark is " + std::to_string(one) + ", not 1");
}

void read_format(GmshReader& g) {
  if (g.version != 0) g.in.fail("$MeshFormat stands here again");
  const std::string_view version = g.in.word("the version");
  if (version == "2" || version == "2.0" || version == "2.1" || version == "2.2") g.version = 2;
  if (version == "4.1") g.version = 4;
  if (g.version == 0)
    g.in.fail("gmsh format " + in_quotes(version) +
              " is not read; save it as 4.1 or 2.2 (gmsh -save -format msh41)");
  const std::int64_t type = g.in.integer("the file type");
  if (type != 0 && type != 1)
    g.in.fail("the file type is " + std::to_string(type) + ", not 0 (ASCII) or 1 (binary)");
  const std::int64_t size = g.in.integer("the size of a number");
  if (size != 8) g.in.fail("numbers have " + std::to_string(size) + " bytes, not 8");
  g.is_binary = type == 1;
  if (g.is_binary) read_byte_order(g);
  end_section(g, "$EndMeshFormat");
}

// Text in binary files as well. The name stands between the first and the last quote of the line.
void read_physical_names(GmshReader& g) {
  constexpr std::int64_t most = 100000;
  const std::int64_t count = g.in.integer("the number of physical names");
  if (count > most) g.in.fail("more than " + std::to_string(most) + " physical names");
  const std::size_t n = g.in.check_count(count, 6, "physical names");
  for (std::size_t k = 0; k < n; ++k) {
    const std::int64_t dimension = g.in.integer("a dimension");
    if (dimension < 0 || dimension > 3)
      g.in.fail("the dimension of a physical name is " + std::to_string(dimension));
    const std::int32_t tag = gmsh_physical_tag(g);
    const std::string_view line = g.in.line();
    const std::size_t first = line.find('"'), last = line.rfind('"');
    if (first == last) g.in.fail("a physical name should stand in double quotes");
    g.mesh.named_groups.push_back(
        {static_cast<int>(dimension), tag, std::string(line.substr(first + 1, last - first - 1))});
  }
  end_section(g, "$EndPhysicalNames");
}

void skip_section(GmshReader& g, const std::string& name) {
  const std::string end = "$End" + name.substr(1);
  const std::size_t at = g.in.rest().find(end);
  if (at == std::string_view::npos)
    g.in.fail("section " + in_quotes(name) + " has no " + in_quotes(end) + ": the file is cut off");
  g.in.take(at + end.size(), "a section");
}

void read_nodes(GmshReader& g, std::string_view section) {
  if (g.node_of) g.in.fail("the nodes stand here again");
  if (section == "$NOD") {
    if (g.version != 0) g.in.fail("$NOD belongs to format 1.0");
    g.version = 1;
    read_nodes_2(g, "$ENDNOD");
  } else if (g.version == 2) {
    read_nodes_2(g, "$EndNodes");
  } else if (g.version == 4) {
    read_nodes_4(g);
  } else {
    g.in.fail("$MeshFormat should stand before $Nodes");
  }
}

void read_elements(GmshReader& g, std::string_view section) {
  if (!g.node_of) g.in.fail("the elements stand before the nodes");
  if (g.has_elements) g.in.fail("the elements stand here again");
  g.has_elements = true;
  if ((section == "$ELM") != (g.version == 1))
    g.in.fail("this section does not fit the version of the file");
  if (g.version == 1) read_elements_1(g);
  if (g.version == 2) read_elements_2(g);
  if (g.version == 4) read_elements_4(g);
  const TagIndex cell_of(g.mesh.cell_tag);
  if (const std::int32_t c = cell_of.duplicate(); c >= 0)
    g.in.fail_file("element " + std::to_string(g.mesh.cell_tag[c]) + " is listed twice");
}

void read_section(GmshReader& g) {
  const std::string section(g.in.word("a section"));
  if (section.front() != '$') g.in.fail("a section like $Nodes should stand here");
  if (section == "$MeshFormat") return read_format(g);
  if (section == "$PhysicalNames") return read_physical_names(g);
  if (section == "$Nodes" || section == "$NOD") return read_nodes(g, section);
  if (section == "$Elements" || section == "$ELM") return read_elements(g, section);
  if (section == "$Entities" && g.version == 4) return read_entities_4(g);
  if (section == "$PartitionedEntities")
    g.in.fail("a partitioned mesh is not read: save it in one piece");
  skip_section(g, section);
}

}  // namespace

RawMesh read_gmsh(FileReader& in) {
  GmshReader g{.in = in, .mesh = {}, .node_of = {}, .entities = {}};
  g.mesh.file = in.file();
  g.mesh.tag_word = "gmsh tag";
  while (!in.is_at_end()) read_section(g);
  if (!g.node_of) in.fail_file("holds no nodes");
  if (!g.has_elements) in.fail_file("holds no elements");
  return std::move(g.mesh);
}

}  // namespace trocar
