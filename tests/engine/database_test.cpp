#include "engine/database.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>

#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

using Mode = Database::Mode;

TEST(Database, gives_back_values_of_every_kind) {
  const TestFolder folder;
  const std::string file = folder.file("d");
  const std::vector<std::byte> bytes = {std::byte{0}, std::byte{255}, std::byte{7}};
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  {
    Database database(file, Mode::create);
    database.run("CREATE TABLE t (i INTEGER, r REAL, s TEXT, b BLOB, e BLOB)");
    Statement insert(database, "INSERT INTO t VALUES (?, ?, ?, ?, ?)");
    insert.bind(0, least).bind(1, 0.1).bind(2, "it's \"ä\"; DROP TABLE t").bind(3, bytes);
    insert.bind(4, std::span<const std::byte>()).step();
  }
  Database database(file, Mode::read);
  Statement row(database, "SELECT * FROM t");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.integer(0), least);
  EXPECT_EQ(row.real(1), 0.1);
  EXPECT_EQ(row.text(2), "it's \"ä\"; DROP TABLE t");
  EXPECT_EQ(row.bytes(3), bytes);
  EXPECT_TRUE(row.bytes(4).empty());
  EXPECT_FALSE(row.step());
}

TEST(Database, statements_can_be_used_again_after_reset) {
  const TestFolder folder;
  Database database(folder.file("d"), Mode::create);
  database.run("CREATE TABLE t (i INTEGER)");
  Statement insert(database, "INSERT INTO t VALUES (?)");
  for (std::int64_t k = 0; k < 5; ++k) {
    EXPECT_FALSE(insert.bind(0, k).step());
    insert.reset();
  }
  Statement sum(database, "SELECT COUNT(*), SUM(i) FROM t");
  ASSERT_TRUE(sum.step());
  EXPECT_EQ(sum.integer(0), 5);
  EXPECT_EQ(sum.integer(1), 0 + 1 + 2 + 3 + 4);
}

TEST(Database, creation_replaces_a_file_of_that_name_with_its_log) {
  const TestFolder folder;
  const std::string file = folder.file("d");
  write_text(file, "something else");
  write_text(file + "-wal", "an old log");
  { Database(file, Mode::create).run("CREATE TABLE t (i INTEGER)"); }
  Database database(file, Mode::read);
  Statement count(database, "SELECT COUNT(*) FROM t");
  EXPECT_TRUE(count.step());
}

TEST(Database, wrong_statements_while_writing_are_machine_errors_with_the_path) {
  const TestFolder folder;
  Database database(folder.file("d"), Mode::create);
  EXPECT_TRUE(contains(error_of<MachineError>([&] { database.run("NONSENSE"); }),
                       folder.file("d") + ": can't be written ("));
  EXPECT_THROW(Statement(database, "SELECT * FROM nothing"), MachineError);
}

TEST(Database, places_that_can_not_be_written_are_machine_errors) {
  const TestFolder folder;
  EXPECT_THROW(Database(folder.file("no/such/folder/d"), Mode::create), MachineError);
  std::filesystem::create_directory(folder.file("sub"));
  EXPECT_THROW(Database(folder.file("sub"), Mode::create), MachineError);
  EXPECT_TRUE(std::filesystem::is_directory(folder.file("sub")));
}

TEST(Database, what_is_no_file_is_refused_without_waiting) {
  const TestFolder folder;
  const auto trouble = [](const std::string& file) {
    return error_of([&] { Database(file, Mode::read); });
  };
  EXPECT_EQ(trouble(folder.file("absent")), folder.file("absent") + ": no such recording");
  EXPECT_EQ(trouble(folder.path()), folder.path() + ": is not a file");
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(trouble(folder.file("pipe")), folder.file("pipe") + ": is not a file");
  EXPECT_EQ(trouble("/dev/zero"), "/dev/zero: is not a file");
}

TEST(Database, a_file_of_another_kind_is_an_input_error) {
  const TestFolder folder;
  const std::string file = write_text(folder.file("text"), std::string(5000, 'x'));
  const std::string sentence = error_of([&] {
    Database database(file, Mode::read);
    Statement(database, "SELECT * FROM frame").step();
  });
  EXPECT_TRUE(contains(sentence, file + ": is no readable recording (")) << sentence;
}

}  // namespace
}  // namespace trocar
