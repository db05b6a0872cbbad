#include "study/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/uio.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace hybrid_sphere::study {
namespace {

constexpr std::uint64_t magic = 0x314a53'5953'5948ULL;  // HYSYSJ1

struct Record {
  std::uint64_t chunk;
  std::uint64_t size;
  std::uint64_t check;  // Adler-32 of chunk, size and bytes
};

std::uint64_t check_of(const Record& record, const unsigned char* bytes) {
  uLong sum = adler32(0, nullptr, 0);
  sum = adler32(sum, reinterpret_cast<const unsigned char*>(&record), 2 * sizeof(std::uint64_t));
  return record.size == 0 ? sum : adler32_z(sum, bytes, record.size);  // which is 1 for a null pointer
}

std::vector<unsigned char> head_of(const std::string& identity) {
  const std::uint64_t size = identity.size();
  std::vector<unsigned char> head(sizeof magic + sizeof size + identity.size());
  std::memcpy(head.data(), &magic, sizeof magic);
  std::memcpy(head.data() + sizeof magic, &size, sizeof size);
  std::copy(identity.begin(), identity.end(), head.begin() + sizeof magic + sizeof size);
  return head;
}

}  // namespace

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

Journal::Journal(Journal&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      end_(other.end_),
      places_(std::move(other.places_)) {}

void Journal::fail(const char* what) const {
  throw FileError("\"" + file_ + "\" " + what + ": " + std::strerror(errno));
}

Journal Journal::create(const std::string& file, const std::string& identity) {
  Journal journal(file, ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (journal.descriptor_ < 0) journal.fail("cannot be made");
  journal.lock();
  try {
    journal.write(nullptr, 0, head_of(identity));
  } catch (...) {
    ::unlink(file.c_str());
    throw;
  }
  return journal;
}

Journal Journal::open(const std::string& file, const std::string& identity) {
  Journal journal(file, ::open(file.c_str(), O_RDWR | O_CLOEXEC));
  if (journal.descriptor_ < 0) journal.fail("cannot be opened");
  journal.lock();
  journal.find_records(identity);
  return journal;
}

void Journal::lock() const {
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) throw FileError("\"" + file_ + "\" is being written by another process");
  if (errno != ENOLCK && errno != EOPNOTSUPP) fail("cannot be locked");  // a file system without locks
}

bool Journal::read_at(std::uint64_t begin, void* bytes, std::size_t size) const {
  auto* to = static_cast<unsigned char*>(bytes);
  while (size > 0) {
    const ssize_t got = pread(descriptor_, to, size, static_cast<off_t>(begin));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot be read");
    if (got == 0) return false;
    to += got;
    begin += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Cuts off what a process that died has written in part.
void Journal::find_records(const std::string& identity) {
  const std::vector<unsigned char> head = head_of(identity);
  const off_t length = lseek(descriptor_, 0, SEEK_END);
  if (length < 0) fail("cannot be read");
  std::vector<unsigned char> found(std::min<std::size_t>(head.size(), static_cast<std::size_t>(length)));
  if (!read_at(0, found.data(), found.size()) || !std::equal(found.begin(), found.end(), head.begin())) {
    throw ForeignFile("\"" + file_ + "\" belongs to another study, another scene or another version");
  }
  if (found.size() < head.size()) {  // the process died before it had a chunk
    if (ftruncate(descriptor_, 0) != 0) fail("cannot be cut");
    write(nullptr, 0, head);
    return;
  }
  end_ = head.size();
  Record record{};
  std::vector<unsigned char> bytes;
  while (read_at(end_, &record, sizeof record) &&
         record.size <= static_cast<std::uint64_t>(length) - end_ - sizeof record) {
    bytes.resize(record.size);
    if (!read_at(end_ + sizeof record, bytes.data(), bytes.size())) break;
    if (check_of(record, bytes.data()) != record.check) break;
    places_.emplace(record.chunk, Place{end_ + sizeof record, record.size});
    end_ += sizeof record + record.size;
  }
  if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) fail("cannot be cut");
}

/// Two pieces at the end. Where that fails, nothing of them stays.
void Journal::write(const void* head, std::size_t head_size, const std::vector<unsigned char>& bytes) {
  const std::size_t size = head_size + bytes.size();
  std::size_t written = 0;
  while (written < size) {
    // Neither piece is changed.
    std::array<iovec, 2> pieces{
        {{const_cast<void*>(head), head_size}, {const_cast<unsigned char*>(bytes.data()), bytes.size()}}};
    std::size_t left = written;
    for (iovec& piece : pieces) {
      const std::size_t begin = std::min(left, piece.iov_len);
      piece.iov_base = static_cast<char*>(piece.iov_base) + begin;
      piece.iov_len -= begin;
      left -= begin;
    }
    const ssize_t more = pwritev(descriptor_, pieces.data(), 2, static_cast<off_t>(end_ + written));
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) {
      const int why = errno;
      if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) errno = why;
      errno = why;
      fail("cannot be written");
    }
    written += static_cast<std::size_t>(more);
  }
  end_ += size;
}

void Journal::append(std::uint64_t chunk, const std::vector<unsigned char>& bytes) {
  Record record{chunk, bytes.size(), 0};
  record.check = check_of(record, bytes.data());
  const std::uint64_t begin = end_ + sizeof record;
  write(&record, sizeof record, bytes);
  places_.emplace(chunk, Place{begin, bytes.size()});
}

std::vector<unsigned char> Journal::read(std::uint64_t chunk) const {
  return read(chunk, 0, places_.at(chunk).size);
}

std::vector<unsigned char> Journal::read(std::uint64_t chunk, std::uint64_t begin, std::uint64_t size) const {
  std::vector<unsigned char> bytes(size);
  if (!read_at(places_.at(chunk).begin + begin, bytes.data(), bytes.size())) {
    throw FileError("\"" + file_ + "\" has become shorter");
  }
  return bytes;
}

}  // namespace hybrid_sphere::study
