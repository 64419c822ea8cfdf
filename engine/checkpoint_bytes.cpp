// A checkpoint's layout: mark, format, three sections (displacements and velocities, whose bytes
// are shuffled, the frames' rows, and all the rest), checksum of everything before it. A section is
// a row of packed blobs, an empty one at its end, so that a large body is written piece by piece.
#include "base/digest.h"
#include "base/error.h"
#include "engine/archive_cut.h"
#include "engine/blob.h"
#include "engine/checkpoint.h"
#include "engine/part_search.h"
#include "engine/swept_area.h"
#include "mesh/quality.h"

namespace trocar {

constexpr std::array<char, 8> checkpoint_mark = {'t', 'r', 'o', 'c', 'h', 'k', 'p', 't'};
constexpr std::uint32_t checkpoint_format = 34;

static void visit(Saver& a, std::shared_ptr<const Mesh>& mesh) {
  a(std::uint64_t{n_bytes_of(*mesh)});
  put_mesh(a, *mesh);
}
static void visit(Loader& a, std::shared_ptr<const Mesh>& mesh) {
  std::vector<std::byte> bytes;
  a(bytes);
  mesh = std::make_shared<const Mesh>(mesh_from_bytes(bytes));
}
template <class Archive>
static void visit(Archive& a, BladePush& p) {
  a(p.way, p.along);
}
template <class Archive>
static void visit(Archive& a, CutRecord& r) {
  a(r.tool, r.start, r.end, r.figures, r.n_edits, r.n_ranks, r.n_askew, r.n_pieces,
    r.n_elements_added, r.n_elements_dissolved, r.stable_step_ratio, r.scene_step_ratio,
    r.scene_step_before, r.least_quality, r.mass_change, r.momentum_change, r.kinetic_energy_change,
    r.strain_energy_change, r.blade_travel, r.deepest, r.push, r.swept_area, r.parted_area,
    r.seconds, r.worst_seconds);
}
template <class Archive>
static void visit(Archive& a, CutMemory& m) {
  a(m.stroke, m.plane_path, m.plane_tip, m.is_in_stroke, m.n_idle_frames, m.has_told_beside,
    m.strokes, m.is_engaged, m.tissue_velocity, m.knows_tissue, m.swept, m.push);
}
template <class Archive>
static void visit(Archive& a, Hold& h) {
  a(h.node, h.tool, h.support, h.offset);
}
template <class Archive>
static void visit(Archive& a, Watch& w) {
  a(w.stable_step, w.stable_element, w.least_J, w.least_J_element, w.is_finite, w.bad_node);
}
template <class Archive>
static void visit(Archive& a, ToolRow& r) {
  a(r.position, r.force, r.torque);
}
template <class Archive>
static void visit(Archive& a, EnergyState& e) {
  a(e.kinetic, e.strain, e.hourglass, e.gravity);
}
template <class Archive>
static void visit(Archive& a, EnergyWorks& w) {
  a(w.contact, w.holds, w.blade, w.loads, w.damping, w.viscous, w.cut);
}
template <class Archive>
static void visit(Archive& a, EnergyMemory& m) {
  a(m.first_frame, m.works, m.initial, m.largest_stored, m.largest_hourglass_share);
}
template <class Archive>
static void visit(Archive& a, FrameRow& r) {
  a(r.frame, r.step, r.n_substeps, r.time, r.dt, r.stable_step, r.least_J, r.asleep, r.energy,
    r.works, r.energy_error, r.wound_width, r.wound_width_mean, r.n_contacts, r.n_tissue_contacts,
    r.n_held, r.n_edits, r.n_pieces, r.tools, r.support_forces, r.markers, r.seconds, r.latency);
}
template <class Archive>
static void visit(Archive& a, Searches& n) {
  a(n.n_of_body, n.n_of_parts);
}
template <class Archive>
static void visit(Archive& a, Equilibrium& e) {
  a(e.iterations, e.residual, e.seconds);
}
template <class Archive>
static void visit(Archive& a, ToldOnce& t) {
  a(t.no_local_steps, t.sunk_tissue);
}
template <class Archive>
static void visit(Archive& a, RunTally& t) {
  a(t.equilibrium, t.n_roll_backs, t.n_deadlines_missed, t.searches, t.least_J, t.least_J_element,
    t.told, t.least_stable_step, t.largest_stable_step, t.events);
}
template <class Archive>
static void visit(Archive& a, SearchMemory& m) {
  a(m.at_step, m.step, m.of_small, m.growth, m.asked, m.searched);
}
template <class Archive>
static void visit(Archive& a, QuietRange& r) {
  a(r.recent, r.low, r.high);
}
template <class Archive>
static void visit(Archive& a, OutputMark& m) {
  a(m.kind, m.file, m.last_frame, m.pending);
}
// All but u, v and rows.
template <class Archive>
static void visit(Archive& a, Checkpoint& c) {
  a(c.version, c.simd, c.scene, c.body_crc, c.frame, c.digest, c.mesh, c.fixed, c.duplicate_parent,
    c.duplicate_node, c.time, c.last_dt, c.step, c.step_scale, c.held_step, c.held_by_contact,
    c.watch, c.holds, c.is_open, c.cuts, c.tally, c.history, c.history_time, c.searches,
    c.looked_at, c.has_stiffening, c.local_steps, c.sleep, c.quiet_range, c.has_energies, c.energy,
    c.outputs);
}

static void put_blob(ByteWriter& writer, const Blob& blob) {
  writer.put(blob.plain_size);
  writer.put(blob.crc);
  writer.put_vector(blob.packed);
}

static Blob get_blob(ByteReader& reader) {
  Blob blob;
  blob.plain_size = reader.get<std::uint64_t>();
  blob.crc = reader.get<std::uint32_t>();
  blob.packed = reader.get_vector<std::byte>();
  return blob;
}

// Turns pieces into blobs.
static ByteSink packed_to(const ByteSink& sink, std::size_t item_size) {
  return [&sink, item_size](std::span<const std::byte> plain) {
    ByteWriter writer;
    put_blob(writer, pack_blob(plain, item_size));
    sink(writer.take());
  };
}

static constexpr std::ptrdiff_t rows_in_blob = 256;

static void pack_rows(std::span<const FrameRow> rows, ByteWriter& blobs) {
  if (rows.empty()) return;  // an empty blob would end the section
  Saver saver;
  for (const FrameRow& row : rows) saver(row);
  put_blob(blobs, pack_blob(saver.take(), 1));
}

// Of the last frame's row, its latency is still to come.
static void put_rows(std::span<const FrameRow> rows, PackedRows& packed, const ByteSink& sink) {
  for (; packed.n + rows_in_blob < std::ssize(rows); packed.n += rows_in_blob) {
    ByteWriter blob;
    pack_rows(rows.subspan(static_cast<std::size_t>(packed.n), rows_in_blob), blob);
    packed.blobs.push_back(blob.take());
  }
  for (const std::vector<std::byte>& blob : packed.blobs) sink(blob);
  ByteWriter rest;
  pack_rows(rows.subspan(static_cast<std::size_t>(packed.n)), rest);
  sink(rest.take());
}

void put_checkpoint(const Checkpoint& checkpoint, PackedRows& packed, const ByteSink& sink) {
  std::uint32_t crc = 0;
  const ByteSink checked = [&](std::span<const std::byte> bytes) {
    crc = crc32c(bytes, crc);
    sink(bytes);
  };
  ByteWriter head(checked);
  head.put(checkpoint_mark);
  head.put(checkpoint_format);
  head.flush();
  const ByteSink shuffled = packed_to(checked, sizeof(double)), plain = packed_to(checked, 1);
  ByteWriter motion(shuffled);
  motion.put_vector(checkpoint.u);
  motion.put_vector(checkpoint.v);
  motion.flush();
  shuffled({});
  put_rows(*checkpoint.rows, packed, checked);
  plain({});
  Saver rest(plain);
  rest(checkpoint);
  rest.writer().flush();
  plain({});
  sink(std::as_bytes(std::span(&crc, 1)));
}

static std::vector<std::byte> get_section(ByteReader& reader, std::size_t item_size,
                                          const std::string& name) {
  std::vector<std::byte> bytes;
  for (;;) {
    const Blob blob = get_blob(reader);
    if (blob.plain_size == 0) return bytes;
    const std::vector<std::byte> more = unpack_blob(blob, item_size, name);
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
}

// The blobs without mark, format and checksum.
static std::span<const std::byte> checked_body(std::span<const std::byte> bytes,
                                               const std::string& name) {
  constexpr std::size_t head = sizeof checkpoint_mark + sizeof checkpoint_format;
  if (bytes.size() < head + sizeof(std::uint32_t) ||
      std::memcmp(bytes.data(), checkpoint_mark.data(), sizeof checkpoint_mark) != 0)
    throw InputError(name + ": is no checkpoint");
  const std::span<const std::byte> covered = bytes.first(bytes.size() - sizeof(std::uint32_t));
  if (ByteReader(bytes.last(sizeof(std::uint32_t))).get<std::uint32_t>() != crc32c(covered))
    throw InputError(name + ": damaged (its checksum does not match); start without --resume");
  const auto format = ByteReader(bytes.subspan(sizeof checkpoint_mark)).get<std::uint32_t>();
  if (format != checkpoint_format)
    throw InputError(name + ": has checkpoint format " + std::to_string(format) +
                     ", this program reads " + std::to_string(checkpoint_format));
  return covered.subspan(head);
}

static std::vector<FrameRow> rows_from_bytes(std::span<const std::byte> bytes) {
  std::vector<FrameRow> rows;
  for (Loader load(bytes); !load.is_at_end();) load(rows.emplace_back());
  return rows;
}

Checkpoint checkpoint_from_bytes(std::span<const std::byte> bytes, const std::string& name) {
  ByteReader reader(checked_body(bytes, name));
  const std::vector<std::byte> motion = get_section(reader, sizeof(double), name);
  const std::vector<std::byte> rows = get_section(reader, 1, name);
  const std::vector<std::byte> rest = get_section(reader, 1, name);
  Checkpoint c;
  Loader load(rest);
  load(c);
  ByteReader fields(motion);
  c.u = fields.get_vector<double>();
  c.v = fields.get_vector<double>();
  c.rows = std::make_shared<const std::vector<FrameRow>>(rows_from_bytes(rows));
  const std::vector<std::string> faults = validate(*c.mesh, 1);
  if (!faults.empty()) throw InputError(name + ": mesh: " + faults.front());
  return c;
}

}  // namespace trocar
