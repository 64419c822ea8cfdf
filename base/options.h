// Options are declared once: key, member, dimension, range and one line of doc. From that come
// reading with checks, the echo of all effective values, and the help. The TOML parser is seen by
// options_toml.cpp alone.
//
//   Options<Material> material("What the tissue is made of.");
//   material.number("young_modulus", &Material::young_modulus, dim::pressure, positive, "Young's
//   modulus E.");
//
// A member's default is what its struct initialises it to.
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "base/vec.h"

namespace trocar {

// Allowed values: an interval whose ends may be open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool is_low_open = false;
  bool is_high_open = false;
};
inline constexpr Range any{};
inline constexpr Range positive{.low = 0, .is_low_open = true};
inline constexpr Range not_negative{.low = 0};

enum class Need { optional, required };

// One value or table of the parsed file; opaque outside options*.cpp.
struct OptionNode;
// One key of a table: how it is read into the object that the table describes, printed, and
// explained.
struct OptionEntry {
  std::string key{};
  std::string type_text{};   // "number [Pa]", "list of tables", …
  std::string range_text{};  // what is allowed, "" for anything of the type
  std::string default_text{};
  std::string doc{};
  Need need = Need::optional;
  // For values. The text is TOML; "" where the value can't be written (an infinite default) and so
  // is left to the default.
  std::function<void(const OptionNode&, void* object)> read{};
  std::function<std::string(const void* object)> value_text{};
  // For tables and lists of tables: the keys below, the `n` objects to read them into, and those to
  // echo.
  bool is_table = false;
  bool is_list = false;
  std::vector<OptionEntry> below{};
  std::function<std::vector<void*>(void* object, std::size_t n)> make_below{};
  std::function<std::vector<const void*>(const void* object)> objects_below{};
};

// Where each key of a file stands: "tissue.material.density" or "instrument[1].path[0]" -> place.
class SourceMap {
 public:
  // The place of the key or, if it is not in the file, of the nearest table above it.
  SourcePlace find(const std::string& key_path) const;
  // The place, the key, the sentence and the source line.
  std::string message(const std::string& key_path, const std::string& sentence) const;
  // Throws InputError with this message.
  [[noreturn]] void fail(const std::string& key_path, const std::string& sentence) const;
  std::map<std::string, SourcePlace> places;
  std::string file;
  std::string text;  // of the file
};

// An error of a key, or of a file before it has keys.
struct OptionError {
  int source = 0;  // 0: the file, i: override i - 1
  int line = 0;
  int column = 0;
  std::string key_path;
  std::string message;
};

// What is wrong with a file, collected so that all of it is told at once. More errors than
// max_shown are only counted: a hostile file can have very many.
class OptionErrors {
 public:
  static constexpr std::size_t max_shown = 100;
  explicit OptionErrors(const SourceMap& where) : where_(&where) {}
  // Of what can't be read.
  void add(OptionError error);
  // Of what was read. Left out where it may follow from what is known already: at the same key, and
  // in a table at the top ("tissue", "support[1]") of which something can't be read.
  void add(const std::string& key_path, const std::string& sentence);
  // The same at the first of these keys that is in the file, or at the last.
  void add_at_first(std::initializer_list<std::string> key_paths, const std::string& sentence);
  const SourceMap& where() const { return *where_; }
  bool is_empty() const { return n_ == 0; }
  bool is_full() const { return shown_.size() >= max_shown; }
  // Throws InputError with all errors in the order of the file, if there are any.
  void throw_if_any() const;

 private:
  const SourceMap* where_;
  std::vector<OptionError> shown_;
  std::size_t n_ = 0;
  std::set<std::string> wrong_keys_, unread_tables_;
};

// The untyped half of Options<T>; see there.
class OptionTable {
 public:
  explicit OptionTable(std::string doc) : doc_(std::move(doc)) {}
  const std::string& doc() const { return doc_; }
  const std::vector<OptionEntry>& entries() const { return entries_; }

 protected:
  // CHECKs that the key is new and can stand in TOML without quotes. `defaults`: an object as its
  // type initialises it.
  void add(OptionEntry entry, const void* defaults);

 private:
  std::string doc_;
  std::vector<OptionEntry> entries_;
};

// Readers of single values; they throw InputError with place, what was found and what is allowed.
double read_number(const OptionNode&, const Dimension&, const Range&);
int read_integer(const OptionNode&, const Range&);
bool read_boolean(const OptionNode&);
std::string read_text(const OptionNode&);
std::vector<double> read_numbers(const OptionNode&, const Dimension&, std::size_t n, const Range&);
std::vector<int> read_integers(const OptionNode&, std::size_t n, const Range&);
std::size_t read_choice(const OptionNode&, const std::vector<std::string>& names);

// Path of an item of a list in the scene: "support[2]".
std::string item_path(const std::string& list, std::size_t number);
// TOML texts of values, numbers as number_text has them.
std::string numbers_text(std::span<const double> values);
std::string integers_text(std::span<const int> values);
std::string quoted_text(const std::string& value);
// "number [Pa]", "> 0 Pa"
std::string number_type_text(const Dimension&);
std::string range_text(const Range&, const Dimension&);
std::string choices_text(const std::vector<std::string>& names);

// The options of a struct T.
template <class T>
class Options : public OptionTable {
 public:
  using OptionTable::OptionTable;

  Options& number(const std::string& key, double T::*member, const Dimension& dimension,
                  const Range& range, const std::string& doc, Need need = Need::optional);
  Options& integer(const std::string& key, int T::*member, const Range& range,
                   const std::string& doc, Need need = Need::optional);
  Options& boolean(const std::string& key, bool T::*member, const std::string& doc);
  Options& text(const std::string& key, std::string T::*member, const std::string& doc,
                Need need = Need::optional);
  Options& vector(const std::string& key, Vec3 T::*member, const Dimension& dimension,
                  const Range& range, const std::string& doc, Need need = Need::optional);
  template <std::size_t N>
  Options& integers(const std::string& key, std::array<int, N> T::*member, const Range& range,
                    const std::string& doc);
  template <class E>
  Options& choice(const std::string& key, E T::*member,
                  const std::vector<std::pair<std::string, E>>& choices, const std::string& doc,
                  Need need = Need::optional);
  // A sub-table; an optional one is a member std::optional<U>; a list is an array of tables.
  // Its doc is that of `below`, which a list may have one of its own in place of.
  template <class U>
  Options& table(const std::string& key, U T::*member, const Options<U>& below,
                 Need need = Need::optional);
  template <class U>
  Options& table(const std::string& key, std::optional<U> T::*member, const Options<U>& below);
  template <class U>
  Options& list(const std::string& key, std::vector<U> T::*member, const Options<U>& below,
                Need need = Need::optional) {
    return list(key, member, below, below.doc(), need);
  }
  template <class U>
  Options& list(const std::string& key, std::vector<U> T::*member, const Options<U>& below,
                const std::string& doc, Need need = Need::optional);

 private:
  Options& value(OptionEntry entry);
  static T& of(void* object) { return *static_cast<T*>(object); }
  static const T& of(const void* object) { return *static_cast<const T*>(object); }
};

inline constexpr std::size_t max_options_bytes = std::size_t{16} << 20;

// Reads `file` (TOML, at most max_options_bytes) into `object` by `table`. `overrides` are
// "key.path=value" texts that win over the file
// ("tissue.material.density=1000 kg/m^3", "instrument[1].radius='3 mm'").
// Collects all errors of keys and values, each with file:line:column, the source line and a caret,
// unknown keys with the nearest allowed one; what can't be read stays as it was. Throws InputError
// for a file that is no TOML, and for an override of a key that there is not.
void read_options(const OptionTable& table, const std::string& file,
                  const std::vector<std::string>& overrides, void* object, SourceMap& where,
                  OptionErrors& errors);
// The same from text, but throws InputError that lists all errors; `name` stands for the file in
// messages.
void read_options_text(const OptionTable& table, const std::string& text, const std::string& name,
                       const std::vector<std::string>& overrides, void* object, SourceMap& where);
// One effective value with the whole path of its key: "instrument[1].path[0].time".
struct OptionText {
  std::string key, value;
};
// All of them, the values of each table before the tables below it, as echo_options has them.
std::vector<OptionText> flat_options(const OptionTable& table, const void* object);
// All effective values as TOML that reads back to the same struct.
std::string echo_options(const OptionTable& table, const void* object);
// Plain-text help, and the same as Markdown with a heading and a table for each table.
std::string help_options(const OptionTable& table);
std::string markdown_options(const OptionTable& table);

}  // namespace trocar

#include "base/options_inl.h"
