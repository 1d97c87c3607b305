// SQLite behind two small owners: a connection and a prepared statement. Every failure becomes a ResultsFileError that
// names the file.
#pragma once

#include <sqlite3.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "bench/results/results_error.h"

namespace wavecrest {

enum class OpenFor { reading, writing };

class Database {
 public:
  // Writing creates a file that does not exist; reading refuses it.
  Database(const std::filesystem::path& path, OpenFor purpose);

  void execute(const std::string& sql);
  // Throws with SQLite's description of the last failure.
  [[noreturn]] void fail(const std::string& expected) const;

  sqlite3* handle() const { return handle_.get(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Close> handle_;
};

// Values are bound in the order of the question marks, columns read from 0 on.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);

  template <class... Values>
  Statement& bind(const Values&... values) {
    sqlite3_reset(handle_.get());
    int place = 0;
    (bindOne(++place, values), ...);
    return *this;
  }
  bool step();  // true: a row can be read
  void run() {
    while (step()) {
    }
  }

  std::string text(int column) const;
  int64_t integer(int column) const { return sqlite3_column_int64(handle_.get(), column); }
  uint64_t count(int column) const { return static_cast<uint64_t>(integer(column)); }
  uint32_t small(int column) const { return static_cast<uint32_t>(integer(column)); }
  double real(int column) const;  // NULL reads as NaN

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  void bindOne(int place, std::string_view value);
  void bindOne(int place, double value);  // NaN is stored as NULL
  void bindOne(int place, std::integral auto value) { bindInteger(place, static_cast<int64_t>(value)); }
  void bindInteger(int place, int64_t value);
  void check(int status) const;

  Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

// Everything written during its life is written at once by commit(), or not at all.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
  ~Transaction() {
    if (!done_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    database_.execute("COMMIT");
    done_ = true;
  }

 private:
  Database& database_;
  bool done_ = false;
};

}  // namespace wavecrest
