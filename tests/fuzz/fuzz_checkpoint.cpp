// Checkpoints as --resume reads them.
#include "base/check.h"
#include "base/digest.h"
#include "base/error.h"
#include "engine/blob.h"
#include "engine/bytes.h"
#include "engine/checkpoint.h"
#include "engine_checkpoint.h"
#include "fuzz_targets.h"

namespace trocar {

namespace {

constexpr std::size_t checkpoint_head_size = 12;  // mark and format

// A blob of a checkpoint, and of which section it is: 0 has shuffled doubles.
struct SectionBlob {
  Blob blob;
  int section = 0;
  std::size_t item_size() const { return section == 0 ? sizeof(double) : 1; }
};

std::vector<SectionBlob> section_blobs(std::span<const std::byte> body) {
  std::vector<SectionBlob> blobs;
  ByteReader reader(body);
  for (int section = 0; !reader.is_at_end();) {
    SectionBlob& next = blobs.emplace_back();
    next.section = section;
    next.blob.plain_size = reader.get<std::uint64_t>();
    next.blob.crc = reader.get<std::uint32_t>();
    next.blob.packed = reader.get_vector<std::byte>();
    if (next.blob.plain_size == 0) ++section;
  }
  return blobs;
}

void change_blob(SectionBlob& of, const ChangeBytes& change) {
  const std::vector<std::byte> plain = unpack_blob(of.blob, of.item_size(), "a part");
  std::string changed = change({reinterpret_cast<const char*>(plain.data()), plain.size()});
  changed.resize(changed.size() / of.item_size() * of.item_size());
  if (!changed.empty()) of.blob = pack_blob(std::as_bytes(std::span(changed)), of.item_size());
}

std::string checkpoint_of(const std::string& head, const std::vector<SectionBlob>& blobs) {
  ByteWriter writer;
  for (const SectionBlob& part : blobs) {
    writer.put(part.blob.plain_size);
    writer.put(part.blob.crc);
    writer.put_vector(part.blob.packed);
  }
  const std::vector<std::byte> body = writer.take();
  std::string file = head + std::string(reinterpret_cast<const char*>(body.data()), body.size());
  const std::uint32_t crc = crc32c(std::as_bytes(std::span(file)));
  return file.append(reinterpret_cast<const char*>(&crc), sizeof crc);
}

}  // namespace

bool read_checkpoint_bytes(std::string_view bytes) {
  return is_taken([&] {
    const Checkpoint c = checkpoint_from_bytes(std::as_bytes(std::span(bytes)), "c");
    CHECK(c.mesh != nullptr && c.rows != nullptr);
  });
}

std::vector<FuzzSeed> checkpoint_seeds() {
  const std::vector<std::byte> bytes = checkpoint_to_bytes(example_checkpoint());
  return {{"plane", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}}};
}

std::string change_checkpoint(const std::string& file, const ChangeBytes& change,
                              std::uint64_t random) {
  if (file.size() < checkpoint_head_size + sizeof(std::uint32_t)) return change(file);
  try {
    std::vector<SectionBlob> blobs =
        section_blobs(std::as_bytes(std::span(file))
                          .subspan(checkpoint_head_size,
                                   file.size() - checkpoint_head_size - sizeof(std::uint32_t)));
    if (blobs.empty()) return change(file);
    change_blob(blobs[random % blobs.size()], change);
    return checkpoint_of(file.substr(0, checkpoint_head_size), blobs);
  } catch (const InputError&) {
    return change(file);  // no checkpoint, or its parts are damaged
  }
}

}  // namespace trocar
