// One description of a struct's members for writing and reading: `visit(archive, value)` names them
// in order, a Saver turns them into bytes, a Loader gets them back. Member by member, so that no
// padding is stored.
#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "base/vec.h"
#include "engine/bytes.h"

namespace trocar {

template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class T, std::size_t n>
inline constexpr bool is_plain<std::array<T, n>> = is_plain<T>;

// A vector of them goes as it lies in memory: no byte between members.
template <class T>
inline constexpr bool is_dense = is_plain<T> || std::is_same_v<T, Vec3> ||
                                 (std::is_trivially_copyable_v<T> &&
                                  std::has_unique_object_representations_v<T>);

class Saver {
 public:
  Saver() = default;
  explicit Saver(ByteSink sink) : writer_(std::move(sink)) {}
  // Changes nothing: visit() takes them as the Loader needs them.
  template <class... Values>
  void operator()(const Values&... values) {
    (put(const_cast<Values&>(values)), ...);
  }
  std::vector<std::byte> take() { return writer_.take(); }
  ByteWriter& writer() { return writer_; }

 private:
  void put(std::string& text) { writer_.put_text(text); }
  void put(Vec3& v) { (*this)(v[0], v[1], v[2]); }
  template <class T>
  void put(std::vector<T>& values) {
    if constexpr (is_dense<T>) {
      writer_.put_vector(values);
    } else {
      writer_.put(static_cast<std::uint64_t>(values.size()));
      for (T& value : values) put(value);
    }
  }
  template <class T, std::size_t n>
  requires(!is_plain<T>) void put(std::array<T, n>& values) {
    for (T& value : values) put(value);
  }
  template <class T>
  void put(T& value) {
    if constexpr (is_plain<T>)
      writer_.put(value);
    else
      visit(*this, value);
  }
  ByteWriter writer_;
};

// Bytes of a value whose lists are empty: no other one has less.
template <class T>
std::size_t least_bytes() {
  Saver save;
  save(T{});
  return save.take().size();
}

// Throws InputError where the bytes end early.
class Loader {
 public:
  explicit Loader(std::span<const std::byte> bytes) : reader_(bytes) {}
  template <class... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }
  bool is_at_end() const { return reader_.is_at_end(); }

 private:
  void get(std::string& text) { text = reader_.get_text(); }
  void get(Vec3& v) { (*this)(v[0], v[1], v[2]); }
  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (is_dense<T>) {
      values = reader_.get_vector<T>();
    } else {
      values.resize(reader_.get_count(least_bytes<T>()));
      for (T& value : values) get(value);
    }
  }
  template <class T, std::size_t n>
  requires(!is_plain<T>) void get(std::array<T, n>& values) {
    for (T& value : values) get(value);
  }
  template <class T>
  void get(T& value) {
    if constexpr (is_plain<T>)
      value = reader_.get<T>();
    else
      visit(*this, value);
  }
  ByteReader reader_;
};

// What has a format of bytes of its own.
template <class T>
void visit_bytes(Saver& a, T& value, std::vector<std::byte> (*to_bytes)(const T&),
                 T (* /*from_bytes*/)(std::span<const std::byte>)) {
  std::vector<std::byte> bytes = to_bytes(value);
  a(bytes);
}
template <class T>
void visit_bytes(Loader& a, T& value, std::vector<std::byte> (* /*to_bytes*/)(const T&),
                 T (*from_bytes)(std::span<const std::byte>)) {
  std::vector<std::byte> bytes;
  a(bytes);
  value = from_bytes(bytes);
}

}  // namespace trocar
