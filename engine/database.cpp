#include "engine/database.h"

#include <sqlite3.h>

#include <filesystem>

#include "base/error.h"

namespace trocar {

struct Database::Handle {
  sqlite3* connection = nullptr;
  ~Handle() { sqlite3_close_v2(connection); }
};

struct Statement::Handle {
  sqlite3_stmt* statement = nullptr;
  ~Handle() { sqlite3_finalize(statement); }
};

namespace {

// A file that the reader has never seen whole may be a pipe or a folder: refuse before SQLite
// blocks on it.
void check_is_file(const std::string& file) {
  std::error_code trouble;
  if (!std::filesystem::exists(file, trouble)) throw InputError(file + ": no such recording");
  if (!std::filesystem::is_regular_file(file, trouble)) throw InputError(file + ": is not a file");
}

void remove_old(const std::string& file) {
  std::error_code trouble;
  if (std::filesystem::is_directory(file, trouble)) return;  // opening it fails with a sentence
  for (const char* tail : {"", "-wal", "-shm", "-journal"})
    std::filesystem::remove(file + tail, trouble);
}

}  // namespace

Database::Database(const std::string& file, Mode mode)
    : file_(file), mode_(mode), handle_(std::make_unique<Handle>()) {
  if (mode != Mode::create) check_is_file(file);
  if (mode == Mode::create) remove_old(file);
  const int flags =
      mode == Mode::create ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READWRITE;
  int result =
      sqlite3_open_v2(file.c_str(), &handle_->connection, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  if (result != SQLITE_OK &&
      mode == Mode::read) {  // a read-only folder: no place for the write-ahead log's index
    handle_ = std::make_unique<Handle>();
    result = sqlite3_open_v2(file.c_str(), &handle_->connection,
                             SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
  }
  if (result != SQLITE_OK) {
    const std::string reason = sqlite3_errmsg(handle_->connection);
    handle_ = std::make_unique<Handle>();
    fail(reason);
  }
  // A file of unknown origin: nothing that it brings along is called, broken pages are looked for.
  if (mode == Mode::read) run("PRAGMA trusted_schema=OFF; PRAGMA cell_size_check=ON;");
  // Exclusive locking keeps the log's index in memory: no -shm file, nothing to mend after a kill.
  if (mode != Mode::read)
    run("PRAGMA locking_mode=EXCLUSIVE; PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;");
}

Database::~Database() = default;

void Database::run(const std::string& sql) {
  if (sqlite3_exec(handle_->connection, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail(sqlite3_errmsg(handle_->connection));
}

// What a killed run left is read with an index that SQLite writes beside the file.
bool Database::is_hindered() const {
  if (handle_->connection == nullptr) return false;
  const int code = sqlite3_errcode(handle_->connection);
  std::error_code trouble;
  return (code == SQLITE_IOERR || code == SQLITE_FULL || code == SQLITE_CANTOPEN ||
          code == SQLITE_READONLY) &&
         std::filesystem::exists(file_ + "-wal", trouble);
}

void Database::fail(const std::string& what) const {
  if (mode_ == Mode::read && is_hindered())
    throw MachineError(file_ + ": can't be read here (" + what + "): a run that was killed left " +
                       file_ +
                       "-wal, which needs room and permission to write beside it; copy both "
                       "elsewhere");
  if (mode_ == Mode::read) throw InputError(file_ + ": is no readable recording (" + what + ")");
  throw MachineError(file_ + ": can't be written (" + what + ")");
}

Statement::Statement(Database& database, const std::string& sql)
    : database_(database), handle_(std::make_unique<Handle>()) {
  if (sqlite3_prepare_v2(database.handle_->connection, sql.c_str(), -1, &handle_->statement,
                         nullptr) != SQLITE_OK)
    database.fail(sqlite3_errmsg(database.handle_->connection));
}

Statement::~Statement() = default;

Statement& Statement::bound(int result) {
  if (result != SQLITE_OK) database_.fail(sqlite3_errmsg(database_.handle_->connection));
  return *this;
}

Statement& Statement::bind(int k, std::int64_t value) {
  return bound(sqlite3_bind_int64(handle_->statement, k + 1, value));
}

Statement& Statement::bind(int k, double value) {
  return bound(sqlite3_bind_double(handle_->statement, k + 1, value));
}

Statement& Statement::bind(int k, const std::string& text) {
  return bound(sqlite3_bind_text(handle_->statement, k + 1, text.c_str(),
                                 static_cast<int>(text.size()), SQLITE_TRANSIENT));
}

Statement& Statement::bind(int k, std::span<const std::byte> bytes) {
  return bound(
      sqlite3_bind_blob64(handle_->statement, k + 1, bytes.data(), bytes.size(), SQLITE_STATIC));
}

bool Statement::step() {
  const int result = sqlite3_step(handle_->statement);
  if (result != SQLITE_ROW && result != SQLITE_DONE)
    database_.fail(sqlite3_errmsg(database_.handle_->connection));
  return result == SQLITE_ROW;
}

void Statement::reset() {
  sqlite3_reset(handle_->statement);
  sqlite3_clear_bindings(handle_->statement);
}

std::int64_t Statement::integer(int k) const {
  return sqlite3_column_int64(handle_->statement, k);
}
double Statement::real(int k) const {
  return sqlite3_column_double(handle_->statement, k);
}

std::string Statement::text(int k) const {
  const auto* first = reinterpret_cast<const char*>(sqlite3_column_text(handle_->statement, k));
  return first ? std::string(first,
                             static_cast<std::size_t>(sqlite3_column_bytes(handle_->statement, k)))
               : std::string();
}

std::vector<std::byte> Statement::bytes(int k) const {
  const auto* first = static_cast<const std::byte*>(sqlite3_column_blob(handle_->statement, k));
  return {first, first + sqlite3_column_bytes(handle_->statement, k)};
}

}  // namespace trocar
