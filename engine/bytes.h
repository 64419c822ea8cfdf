// Values as bytes, for broadcasts and recordings: little-endian plain data, counts as 64-bit
// numbers. The reader checks every count against the bytes that are left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "mesh/edit.h"
#include "mesh/mesh.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

// Takes bytes piece by piece.
using ByteSink = std::function<void(std::span<const std::byte>)>;

class ByteWriter {
 public:
  ByteWriter() = default;
  // Hands on what is written in pieces of piece_size bytes and keeps no more; the last one, a
  // smaller one, when flush is called.
  explicit ByteWriter(ByteSink sink) : sink_(std::move(sink)) {}
  static constexpr std::size_t piece_size = std::size_t{1} << 20;
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_raw(&value, sizeof value);
  }
  // Eigen's vectors are not trivially copyable, their three doubles are.
  template <class T>
  void put_vector(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T> || std::is_same_v<T, Vec3>);
    put(static_cast<std::uint64_t>(values.size()));
    put_raw(values.data(), values.size() * sizeof(T));
  }
  void put_text(const std::string& text);
  void flush();
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void put_raw(const void* data, std::size_t size);
  std::vector<std::byte> bytes_;
  ByteSink sink_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    if constexpr (std::is_same_v<T, bool>) return get_bool();
    T value;
    get_raw(&value, sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> get_vector() {
    std::vector<T> values(get_count(sizeof(T)));
    get_raw(values.data(), values.size() * sizeof(T));
    return values;
  }
  std::string get_text();
  std::size_t get_count(std::size_t item_size);  // throws InputError if that many can't follow
  bool is_at_end() const { return bytes_.empty(); }

 private:
  void get_raw(void* data, std::size_t size);
  bool get_bool();
  std::span<const std::byte> bytes_;
};

class Saver;  // archive.h
void put_mesh(Saver& save, const Mesh& mesh);
std::size_t n_bytes_of(const Mesh& mesh);
std::vector<std::byte> mesh_to_bytes(const Mesh& mesh);
Mesh mesh_from_bytes(std::span<const std::byte> bytes);
// Of an instrument's surface, as a mesh of triangles. The second throws InputError "<name>: …"
// where it is none.
std::vector<std::byte> surface_to_bytes(const TriangleMesh& surface);
TriangleMesh surface_from_bytes(std::span<const std::byte> bytes, const std::string& name);
std::vector<std::byte> edit_to_bytes(const MeshEdit& edit);
MeshEdit edit_from_bytes(std::span<const std::byte> bytes);

}  // namespace trocar
