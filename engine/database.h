// A thin layer over SQLite: statements with bound values, errors as exceptions. SQLite is seen by
// database.cpp alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace trocar {

class Database;

// A prepared statement; values are bound and columns read by position, from 0.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  // Throws like step().
  Statement& bind(int k, std::int64_t value);
  Statement& bind(int k, double value);
  Statement& bind(int k, const std::string& text);
  Statement& bind(int k, std::span<const std::byte> bytes);  // must live until step()
  // True if there is a row. Throws what the database was opened to throw.
  bool step();
  void reset();
  std::int64_t integer(int k) const;
  double real(int k) const;
  std::string text(int k) const;
  std::vector<std::byte> bytes(int k) const;

 private:
  struct Handle;
  Database& database_;
  std::unique_ptr<Handle> handle_;

  Statement& bound(int result);
};

class Database {
 public:
  enum class Mode { create, extend, read };
  // create: replaces the file; failures are MachineErrors, also of extend, which goes on with one
  // that is there. read: failures are InputErrors, but for what a disk hinders. All "path: reason".
  Database(const std::string& file, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  void run(const std::string& sql);
  [[noreturn]] void fail(const std::string& what) const;

 private:
  friend class Statement;
  bool is_hindered() const;
  struct Handle;
  std::string file_;
  Mode mode_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace trocar
