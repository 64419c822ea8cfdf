// Reading VTU: the tags are scanned once, then the arrays that make the mesh are decoded.
#include <bit>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/quoted.h"
#include "mesh/mesh_file_formats.h"
#include "mesh/vtk_cells.h"
#include "mesh/vtu_data.h"
#include "mesh/xml_tag.h"

namespace trocar {

namespace {

struct VtuArray {
  bool is_present = false;
  VtkNumber number;
  std::string_view format;   // "ascii", "binary" or "appended"
  std::string_view content;  // what stands between its tags
  std::string_view tag;      // for messages
  std::uint64_t offset = 0;  // in the appended data
};

struct VtuReader {
  FileReader& in;
  VtuEncoding encoding;
  std::int64_t n_pieces = 0, n_points = 0, n_cells = 0;
  VtuArray points, connectivity, offsets, types, region, fibre;
  VtkLeftOut left_out;
  std::string_view appended;  // behind its "_"
  bool is_appended_base64 = true;
};

std::uint64_t unsigned_attribute(const FileReader& in, const XmlTag& tag, std::string_view name) {
  const std::string_view text = attribute(tag, name);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value > INT64_MAX)
    in.fail("attribute " + std::string(name) + " of <" + std::string(tag.name) +
            "> should be a number, not " + in_quotes(text));
  return value;
}

void read_file_tag(VtuReader& r, const XmlTag& tag) {
  if (attribute(tag, "type") != "UnstructuredGrid")
    r.in.fail("the VTK file holds " + in_quotes(attribute(tag, "type")) +
              "; only UnstructuredGrid (.vtu) is read");
  const std::string_view order = attribute(tag, "byte_order");
  if (order != "" && order != "LittleEndian" && order != "BigEndian")
    r.in.fail("the byte order is " + in_quotes(order) + ", not LittleEndian or BigEndian");
  const bool is_big = order == "BigEndian";
  r.encoding.swaps_bytes = is_big != (std::endian::native == std::endian::big);
  const std::string_view header = attribute(tag, "header_type");
  if (header != "" && header != "UInt32" && header != "UInt64")
    r.in.fail("the header type is " + in_quotes(header) + ", not UInt32 or UInt64");
  r.encoding.n_header_bytes = header == "UInt64" ? 8 : 4;
  const std::string_view compressor = attribute(tag, "compressor");
  if (compressor != "" && compressor != "vtkZLibDataCompressor")
    r.in.fail("the data are packed by " + in_quotes(compressor) +
              "; save it with vtkZLibDataCompressor or without compression");
  r.encoding.is_zlib = compressor != "";
}

void read_piece_tag(VtuReader& r, const XmlTag& tag) {
  if (r.n_pieces++ > 0) r.in.fail("a second piece begins here; save the mesh in one piece");
  r.n_points = static_cast<std::int64_t>(unsigned_attribute(r.in, tag, "NumberOfPoints"));
  r.n_cells = static_cast<std::int64_t>(unsigned_attribute(r.in, tag, "NumberOfCells"));
  if (r.n_points > INT32_MAX || r.n_cells > INT32_MAX)
    r.in.fail("more than 2147483647 points or cells");
}

// nullptr for an array that the mesh does not need, which is noted.
VtuArray* find_array(VtuReader& r, std::string_view section, std::string_view name) {
  if (section == "Points") return &r.points;
  if (section == "CellData" && name == "region") return &r.region;
  if (section == "CellData" && name == "fibre") return &r.fibre;
  if (section == "CellData") r.left_out.of_cells.emplace_back(name);
  if (section == "PointData") r.left_out.of_points.emplace_back(name);
  if (section != "Cells") return nullptr;
  if (name == "connectivity") return &r.connectivity;
  if (name == "offsets") return &r.offsets;
  return name == "types" ? &r.types : nullptr;
}

void read_array_tag(const VtuReader& r, const XmlTag& tag, VtuArray& array) {
  if (array.is_present)
    r.in.fail("array " + in_quotes(attribute(tag, "Name")) + " stands here again");
  const std::string_view type = attribute(tag, "type");
  const std::optional<VtkNumber> number = find_vtk_number(type);
  if (!number) r.in.fail("there is no type of numbers called " + in_quotes(type));
  array = {.is_present = true,
           .number = *number,
           .format = attribute(tag, "format"),
           .content = tag.text.substr(tag.text.size()),
           .tag = tag.text,
           .offset = 0};
  if (array.format == "appended") array.offset = unsigned_attribute(r.in, tag, "offset");
  if (array.format != "ascii" && array.format != "binary" && array.format != "appended")
    r.in.fail("the format is " + in_quotes(array.format) + ", not ascii, binary or appended");
}

// The rest of the file is appended data, which may be raw: no more tags are looked for.
void read_appended(VtuReader& r, const XmlTag& tag) {
  const std::string_view encoding = attribute(tag, "encoding");
  if (encoding != "base64" && encoding != "raw")
    r.in.fail("the encoding is " + in_quotes(encoding) + ", not base64 or raw");
  r.is_appended_base64 = encoding == "base64";
  const std::string_view rest = r.in.rest();
  const std::size_t begin = rest.find('_');
  const std::size_t end = rest.rfind("</AppendedData");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
    r.in.fail("the appended data are cut off");
  r.appended = rest.substr(begin + 1, end - begin - 1);
}

bool is_section(std::string_view name) {
  return name == "Points" || name == "Cells" || name == "CellData" || name == "PointData" ||
         name == "FieldData";
}

// Information that ParaView puts into an array stands before its numbers, so these are the text in
// front of the closing tag.
void scan_tags(VtuReader& r) {
  std::string_view section;
  VtuArray* array = nullptr;
  bool is_closed = false;
  XmlTag tag;
  while (!is_closed && next_tag(r.in, tag)) {
    if (tag.name == "VTKFile" && !tag.is_end) read_file_tag(r, tag);
    if (tag.name == "VTKFile" && tag.is_end) is_closed = true;
    if (tag.name == "Piece" && !tag.is_end) read_piece_tag(r, tag);
    if (is_section(tag.name)) section = tag.is_end || tag.is_empty ? "" : tag.name;
    if (tag.name == "DataArray" && !tag.is_end) {
      array = find_array(r, section, attribute(tag, "Name"));
      if (array != nullptr) read_array_tag(r, tag, *array);
    }
    if (tag.name == "DataArray" && tag.is_end && array != nullptr) array->content = tag.before;
    if (tag.name == "AppendedData" && !tag.is_end) {
      read_appended(r, tag);
      is_closed = true;
    }
  }
  if (!is_closed) r.in.fail_file("is cut off: </VTKFile> is missing");
}

// The reader whose messages point to the tag of the array.
FileReader reader_at(const VtuReader& r, const VtuArray& array) {
  return r.in.within(array.tag);
}

std::string decode(const VtuReader& r, const FileReader& at, const VtuArray& array,
                   std::size_t n_bytes) {
  VtuEncoding encoding = r.encoding;
  if (array.format == "binary") return decode_vtu_data(at, encoding, array.content, n_bytes);
  encoding.is_base64 = r.is_appended_base64;
  if (array.offset > r.appended.size())
    at.fail("the offset is " + std::to_string(array.offset) + ", but the appended data have " +
            std::to_string(r.appended.size()) + " bytes");
  return decode_vtu_data(at, encoding, r.appended.substr(array.offset), n_bytes);
}

// Calls take(value) for the n numbers; Value is double or int64.
template <class Value, class F>
void read_numbers(const VtuReader& r, const VtuArray& array, std::size_t n, const F& take) {
  constexpr bool is_real = std::is_same_v<Value, double>;
  const FileReader at = reader_at(r, array);
  if (!is_real && array.number.is_float) at.fail("integers are needed here");
  if (array.format == "ascii") {
    FileReader text = r.in.within(array.content);
    text.check_count(static_cast<std::int64_t>(n), 2, "numbers");
    for (std::size_t k = 0; k < n; ++k)
      if constexpr (is_real)
        take(text, text.real("a coordinate"));
      else
        take(text, text.integer("a number"));
    if (!text.is_at_end()) text.fail("more than " + std::to_string(n) + " numbers stand here");
    return;
  }
  const std::size_t n_each = array.number.n_bytes;
  const std::string data = decode(r, at, array, n * n_each);
  for (std::size_t k = 0; k < n; ++k)
    if constexpr (is_real)
      take(at, load_real(data.data() + k * n_each, array.number, r.encoding.swaps_bytes));
    else
      take(at, load_integer(data.data() + k * n_each, array.number, r.encoding.swaps_bytes));
}

void check_present(const VtuReader& r, const VtuArray& array, const char* name) {
  if (!array.is_present) r.in.fail_file(std::string("holds no array ") + name);
}

std::vector<std::int32_t> read_integers(const VtuReader& r, const VtuArray& array, std::size_t n,
                                        const char* name) {
  check_present(r, array, name);
  std::vector<std::int32_t> values;
  read_numbers<std::int64_t>(r, array, n, [&](const FileReader& at, std::int64_t value) {
    if (values.empty()) values.reserve(n);
    values.push_back(fit_int32(at, value, name));
  });
  return values;
}

// `what` is an item of the array in messages.
std::vector<Vec3> read_vectors(const VtuReader& r, const VtuArray& array, std::int64_t count,
                               const char* what) {
  std::vector<Vec3> X;
  const std::size_t n = 3 * static_cast<std::size_t>(count);
  std::size_t k = 0;
  read_numbers<double>(r, array, n, [&](const FileReader& at, double x) {
    if (!std::isfinite(x))
      at.fail("a coordinate of " + std::string(what) + " " + std::to_string(k / 3) +
              " is not finite");
    if (k == 0) X.reserve(n / 3);
    if (k % 3 == 0) X.emplace_back();
    X.back()[static_cast<Eigen::Index>(k++ % 3)] = x;
  });
  return X;
}

std::vector<Vec3> read_points(const VtuReader& r) {
  check_present(r, r.points, "of points");
  return read_vectors(r, r.points, r.n_points, "point");
}

// Some programs write all arrays as floats.
std::vector<std::int32_t> read_regions(const VtuReader& r, std::size_t n) {
  if (!r.region.is_present) return {};
  std::vector<double> number;
  read_numbers<double>(r, r.region, n, [&](const FileReader&, double k) { number.push_back(k); });
  return make_vtk_regions(reader_at(r, r.region), number, r.region.number.is_float);
}

VtkCells read_cells(const VtuReader& r) {
  const auto n = static_cast<std::size_t>(r.n_cells);
  VtkCells cells;
  cells.type = read_integers(r, r.types, n, "types");
  cells.offset = read_integers(r, r.offsets, n, "offsets");
  cells.offset.insert(cells.offset.begin(), 0);
  const std::int32_t n_corners = cells.offset.back();
  if (n_corners < 0) reader_at(r, r.offsets).fail("the last offset is negative");
  cells.connectivity =
      read_integers(r, r.connectivity, static_cast<std::size_t>(n_corners), "connectivity");
  cells.region = read_regions(r, n);
  if (r.fibre.is_present) cells.fibre = read_vectors(r, r.fibre, r.n_cells, "the fibre of cell");
  return cells;
}

}  // namespace

RawMesh read_vtu_cells(FileReader& in) {
  VtuReader r{.in = in,
              .encoding = {},
              .points = {},
              .connectivity = {},
              .offsets = {},
              .types = {},
              .region = {},
              .fibre = {},
              .left_out = {},
              .appended = {}};
  scan_tags(r);
  if (r.n_pieces == 0) in.fail_file("holds no <Piece>");
  RawMesh mesh;
  mesh.file = in.file();
  mesh.tag_word = "cell";
  mesh.X = read_points(r);
  add_vtk_cells(in, read_cells(r), mesh);
  mesh.left_out = left_out_text(r.left_out);
  return mesh;
}

}  // namespace trocar
