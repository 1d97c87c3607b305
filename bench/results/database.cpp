#include "bench/results/database.h"

#include <limits>

namespace wavecrest {
namespace {

constexpr int kBusyMilliseconds = 10000;  // a report may be reading while a campaign writes

// What a call that failed with this status would have needed.
const char* neededAfter(int status) {
  switch (status & 0xff) {  // the bits above tell more of the same failure
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
      return "a writable place with room";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "no other program at work on it";
    default:
      return "an intact results file of a campaign";
  }
}

}  // namespace

Database::Database(const std::filesystem::path& path, OpenFor purpose) : path_(path) {
  sqlite3* handle = nullptr;
  const int flags = purpose == OpenFor::writing ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  const int status = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);  // also a failed open leaves one, which says what was wrong
  if (status != SQLITE_OK) fail(purpose == OpenFor::writing ? "a writable place" : "a results file of a campaign");
  sqlite3_busy_timeout(handle, kBusyMilliseconds);
}

// Runs one or several SQL statements. Rows that they give are ignored.
void Database::execute(const std::string& sql) {
  const int status = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (status != SQLITE_OK) fail(neededAfter(status));
}

void Database::fail(const std::string& expected) const {
  const std::string wrong = handle_ ? sqlite3_errmsg(handle_.get()) : "out of memory";
  throw ResultsFileError(path_.string() + ": " + wrong + "; expected " + expected);
}

Statement::Statement(Database& database, std::string_view sql) : database_(database) {
  sqlite3_stmt* handle = nullptr;
  check(sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()), &handle, nullptr));
  handle_.reset(handle);
}

// SQLITE_ROW is a row, SQLITE_DONE the end of the rows. Everything else is an error.
bool Statement::step() {
  const int status = sqlite3_step(handle_.get());
  if (status == SQLITE_ROW) return true;
  if (status != SQLITE_DONE) check(status);
  return false;
}

std::string Statement::text(int column) const {
  // A column with NULL reads as an empty text.
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return bytes == nullptr ? std::string() : std::string(bytes);
}

double Statement::real(int column) const {
  if (sqlite3_column_type(handle_.get(), column) == SQLITE_NULL) return std::numeric_limits<double>::quiet_NaN();
  return sqlite3_column_double(handle_.get(), column);
}

void Statement::bindOne(int place, std::string_view value) {
  // SQLITE_TRANSIENT makes SQLite copy the text, which may not live until the next step.
  check(sqlite3_bind_text(handle_.get(), place, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT));
}

// SQLite itself turns a NaN into NULL.
void Statement::bindOne(int place, double value) { check(sqlite3_bind_double(handle_.get(), place, value)); }

void Statement::bindInteger(int place, int64_t value) { check(sqlite3_bind_int64(handle_.get(), place, value)); }

void Statement::check(int status) const {
  // A violated constraint and a lock that timed out end here as well, in SQLite's own words.
  if (status != SQLITE_OK) database_.fail(neededAfter(status));
}

}  // namespace wavecrest
