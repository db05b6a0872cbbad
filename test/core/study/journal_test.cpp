// What is written to the journal is found again, whatever happened to the process or the disk in between.

#include "study/journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::journal_test {
namespace {

using study::FileError;
using study::ForeignFile;
using study::Journal;
using Bytes = std::vector<unsigned char>;

Bytes bytes_of(std::size_t size, unsigned seed) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(seed + 31 * i);
  return bytes;
}

void write(const TemporaryFile& file, const std::string& bytes) {
  std::ofstream(file.path(), std::ios::binary | std::ios::trunc) << bytes;
}

const std::string identity = "a study\nof some version";

/// With chunks 4 (of 100 bytes), 0 (of none) and 9 (of 37).
void make(const TemporaryFile& file) {
  Journal journal = Journal::create(file.path(), identity);
  journal.append(4, bytes_of(100, 1));
  journal.append(0, {});
  journal.append(9, bytes_of(37, 2));
}

void expect_first_two(const Journal& journal) {
  EXPECT_EQ(journal.chunks(), 2U);
  ASSERT_TRUE(journal.has(4) && journal.has(0) && !journal.has(9));
  EXPECT_EQ(journal.read(4), bytes_of(100, 1));
  EXPECT_EQ(journal.read(0), Bytes());
}

TEST(Journal, FindsItsChunksAgain) {
  const TemporaryFile file("journal");
  make(file);
  Journal journal = Journal::open(file.path(), identity);
  EXPECT_EQ(journal.chunks(), 3U);
  EXPECT_EQ(journal.bytes(), std::filesystem::file_size(file.path()));
  EXPECT_FALSE(journal.has(1));
  EXPECT_EQ(journal.read(9), bytes_of(37, 2));
  const Bytes whole = bytes_of(100, 1);
  EXPECT_EQ(journal.read(4, 10, 5), Bytes(whole.begin() + 10, whole.begin() + 15));
  journal.append(1, bytes_of(5, 3));
  EXPECT_EQ(journal.read(1), bytes_of(5, 3));
  EXPECT_EQ(journal.read(4), bytes_of(100, 1));
}

TEST(Journal, GoesOnWithWhatItHasAfterAMove) {
  const TemporaryFile file("journal");
  make(file);
  Journal first = Journal::open(file.path(), identity);
  Journal journal(std::move(first));
  journal.append(5, bytes_of(3, 3));
  EXPECT_EQ(journal.chunks(), 4U);
  EXPECT_EQ(journal.read(9), bytes_of(37, 2));
}

TEST(Journal, CutsOffARecordThatEndsAtAnyByte) {
  const TemporaryFile file("journal");
  make(file);
  const std::string whole = file.text();
  const std::size_t last = 24 + 37;  // bytes of the record
  for (std::size_t missing = 1; missing <= last; ++missing) {
    write(file, whole.substr(0, whole.size() - missing));
    Journal journal = Journal::open(file.path(), identity);
    expect_first_two(journal);
    EXPECT_EQ(std::filesystem::file_size(file.path()), whole.size() - last) << missing;
    journal.append(9, bytes_of(37, 2));
    EXPECT_EQ(file.text(), whole) << missing;
  }
}

TEST(Journal, CutsOffZeros) {
  // Which a file system may leave at the end of a file after a crash.
  const TemporaryFile file("journal");
  make(file);
  const std::string whole = file.text();
  { Journal::create(file.path() + "_2", identity); }
  const std::string head = whole.substr(0, std::filesystem::file_size(file.path() + "_2"));
  std::filesystem::remove(file.path() + "_2");
  for (const std::string& begin : {whole, head}) {
    for (const std::size_t zeros : {1U, 24U, 25U, 4096U}) {
      write(file, begin + std::string(zeros, '\0'));
      EXPECT_EQ(Journal::open(file.path(), identity).chunks(), begin == whole ? 3U : 0U);
      EXPECT_EQ(file.text(), begin);
    }
  }
}

TEST(Journal, BeginsAnewWhereTheProcessDiedInItsFirstLine) {
  const TemporaryFile file("journal");
  { Journal::create(file.path(), identity); }
  const std::string head = file.text();
  for (std::size_t size = 0; size <= head.size(); ++size) {
    write(file, head.substr(0, size));
    const Journal journal = Journal::open(file.path(), identity);
    EXPECT_EQ(journal.chunks(), 0U);
    EXPECT_EQ(file.text(), head) << size;
  }
}

TEST(Journal, CutsOffARecordWithAFlippedBit) {
  const TemporaryFile file("journal");
  make(file);
  const std::string whole = file.text();
  const std::size_t last = whole.size() - 24 - 37;
  for (std::size_t byte = last; byte < whole.size(); ++byte) {
    for (const int bit : {0, 3, 7}) {
      std::string flipped = whole;
      flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << bit));
      write(file, flipped);
      expect_first_two(Journal::open(file.path(), identity));
    }
  }
}

TEST(Journal, LosesWhatIsBehindABrokenRecordAndTakesItAnew) {
  const TemporaryFile file("journal");
  make(file);
  std::string broken = file.text();
  broken[broken.size() - 24 - 37 - 24 - 50] ^= 1;  // in chunk 4
  write(file, broken);
  Journal journal = Journal::open(file.path(), identity);
  EXPECT_EQ(journal.chunks(), 0U);
  journal.append(4, bytes_of(100, 1));
  EXPECT_EQ(journal.read(4), bytes_of(100, 1));
}

TEST(Journal, RefusesTheFileOfAnotherStudyAndLeavesItAsItIs) {
  const TemporaryFile file("journal");
  make(file);
  const std::string whole = file.text();
  const std::string longer(whole.size() + 100, 'x');
  for (const std::string& other : {std::string(), std::string("a study"), identity + "2", longer}) {
    EXPECT_THROW(Journal::open(file.path(), other), ForeignFile);
    EXPECT_EQ(file.text(), whole) << "identity of " << other.size();
  }
  for (const char* text : {"a", "not a journal"}) {
    write(file, text);
    EXPECT_THROW(Journal::open(file.path(), identity), ForeignFile);
    EXPECT_EQ(file.text(), text);
  }
}

TEST(Journal, IsMadeOnlyWhereThereIsNoFile) {
  const TemporaryFile file("journal");
  make(file);
  const std::string whole = file.text();
  EXPECT_THROW(Journal::create(file.path(), identity), FileError);
  EXPECT_EQ(file.text(), whole);
  EXPECT_THROW(Journal::create("/not/there", identity), FileError);
  EXPECT_THROW(Journal::open("/not/there", identity), FileError);
  EXPECT_THROW(Journal::open("/", identity), FileError);
  EXPECT_THROW(Journal::open("/dev/null", identity), FileError);
}

TEST(Journal, IsLockedWhileItIsOpen) {
  const TemporaryFile file("journal");
  {
    const Journal journal = Journal::create(file.path(), identity);
    try {
      Journal::open(file.path(), identity);
      ADD_FAILURE() << "opened twice";
    } catch (const FileError& error) {
      EXPECT_EQ(error.what(), "\"" + file.path() + "\" is being written by another process");
    }
  }
  EXPECT_NO_THROW(Journal::open(file.path(), identity));
}

/// Files may not become larger than this for so long.
class LimitedFiles {
 public:
  explicit LimitedFiles(std::uint64_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~LimitedFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  LimitedFiles(const LimitedFiles&) = delete;
  LimitedFiles& operator=(const LimitedFiles&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(Journal, KeepsWhatItHasWhereTheDiskIsFull) {
  const TemporaryFile file("journal");
  make(file);
  const std::string whole = file.text();
  Journal journal = Journal::open(file.path(), identity);
  for (const std::uint64_t room : {0U, 1U, 23U, 24U, 25U, 60U}) {
    {
      const LimitedFiles limited(whole.size() + room);
      EXPECT_THROW(journal.append(7, bytes_of(37, 5)), FileError) << room;
    }
    EXPECT_FALSE(journal.has(7));
    EXPECT_EQ(file.text(), whole) << room;
  }
  journal.append(7, bytes_of(37, 5));
  EXPECT_EQ(journal.read(7), bytes_of(37, 5));
  EXPECT_EQ(journal.read(4), bytes_of(100, 1));
}

TEST(Journal, LeavesNoFileWhereTheDiskIsFullFromTheBeginning) {
  const TemporaryFile file("journal");
  for (const std::uint64_t room : {0U, 5U}) {
    const LimitedFiles limited(room);
    EXPECT_THROW(Journal::create(file.path(), identity), FileError);
    EXPECT_FALSE(std::filesystem::exists(file.path())) << room;
  }
}

TEST(Journal, SaysThatItHasBecomeShorter) {
  const TemporaryFile file("journal");
  make(file);
  const Journal journal = Journal::open(file.path(), identity);
  std::filesystem::resize_file(file.path(), 60);
  EXPECT_THROW(journal.read(9), FileError);
}

}  // namespace
}  // namespace hybrid_sphere::testing::journal_test
