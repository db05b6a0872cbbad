#include "study/team.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace hybrid_sphere::study {
namespace {

enum Tag { result_tag = 1, assignment_tag, stop_tag, finish_tag };

// How long a rank that waits sleeps between two looks.
constexpr auto nap = std::chrono::microseconds(50);

void require(int result) {
  if (result != MPI_SUCCESS) throw std::runtime_error("MPI has failed with code " + std::to_string(result));
}

}  // namespace

/// A result on its way: the chunk, then its bytes.
struct Team::Sending {
  std::vector<unsigned char> bytes;
  MPI_Request request = MPI_REQUEST_NULL;

  bool is_done() {
    int done = 0;
    require(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    return done != 0;
  }
};

bool Team::is_under_mpirun() {
  const char* const variables[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
  return std::any_of(std::begin(variables), std::end(variables),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

bool Team::is_first() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}) {
    if (const char* rank = std::getenv(name)) return std::strcmp(rank, "0") == 0;
  }
  return true;
}

void Team::abort(int exit_code) {
  if (size_ > 1) MPI_Abort(MPI_COMM_WORLD, exit_code);
}

Team::Team() {
  if (!is_under_mpirun()) return;
  require(MPI_Init(nullptr, nullptr));
  has_mpi_ = true;
  require(MPI_Comm_rank(MPI_COMM_WORLD, &rank_));
  require(MPI_Comm_size(MPI_COMM_WORLD, &size_));
}

Team::~Team() {
  if (has_mpi_) MPI_Finalize();
}

std::vector<std::string> Team::gather(const std::string& text) {
  if (!has_mpi_) return {text};
  const int length = static_cast<int>(text.size());
  std::vector<int> lengths(static_cast<std::size_t>(size_));
  require(MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD));
  std::vector<int> offsets;
  int end = 0;
  for (const int each : lengths) {
    offsets.push_back(end);
    end += each;
  }
  std::string all(rank_ == 0 ? static_cast<std::size_t>(end) : 0, '\0');
  require(MPI_Gatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), offsets.data(), MPI_CHAR, 0,
                      MPI_COMM_WORLD));
  std::vector<std::string> texts;
  for (std::size_t i = 0; rank_ == 0 && i < lengths.size(); ++i) {
    texts.push_back(all.substr(static_cast<std::size_t>(offsets[i]), static_cast<std::size_t>(lengths[i])));
  }
  return texts;
}

int Team::from_first(int number) {
  if (!has_mpi_) return number;
  MPI_Request request = MPI_REQUEST_NULL;
  require(MPI_Ibcast(&number, 1, MPI_INT, 0, MPI_COMM_WORLD, &request));
  for (int done = 0; done == 0;) {
    require(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return number;
}

bool Team::has_arrived(int tag, int rank, int& source, int& size) {
  int arrived = 0;
  MPI_Status status;
  require(MPI_Iprobe(rank, tag, MPI_COMM_WORLD, &arrived, &status));
  if (arrived == 0) return false;
  source = status.MPI_SOURCE;
  require(MPI_Get_count(&status, MPI_BYTE, &size));
  return true;
}

std::optional<Team::Result> Team::receive() {
  int source = 0;
  int size = 0;
  if (size_ == 1 || !has_arrived(result_tag, MPI_ANY_SOURCE, source, size)) return std::nullopt;
  Result result{source, 0, std::vector<unsigned char>(static_cast<std::size_t>(size))};
  require(
      MPI_Recv(result.bytes.data(), size, MPI_BYTE, source, result_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE));
  const std::size_t head = result.bytes.size() - sizeof result.chunk;
  std::memcpy(&result.chunk, result.bytes.data() + head, sizeof result.chunk);
  result.bytes.resize(head);
  return result;
}

void Team::assign(int rank, std::int64_t chunk) {
  require(MPI_Send(&chunk, 1, MPI_INT64_T, rank, assignment_tag, MPI_COMM_WORLD));
}

void Team::stop() {
  for (int rank = 1; rank < size_; ++rank) {
    require(MPI_Send(nullptr, 0, MPI_BYTE, rank, stop_tag, MPI_COMM_WORLD));
  }
}

std::int64_t Team::next_chunk() {
  int source = 0;
  int size = 0;
  while (!has_arrived(assignment_tag, 0, source, size)) {
    if (is_stopped()) return no_more;
    std::this_thread::sleep_for(nap);
  }
  std::int64_t chunk = no_more;
  require(MPI_Recv(&chunk, 1, MPI_INT64_T, 0, assignment_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE));
  return chunk;
}

void Team::send(std::uint64_t chunk, std::vector<unsigned char> bytes) {
  constexpr std::size_t most = 2;
  const auto is_done = [](const std::unique_ptr<Sending>& sending) { return sending->is_done(); };
  for (;;) {
    sending_.erase(std::remove_if(sending_.begin(), sending_.end(), is_done), sending_.end());
    if (sending_.size() < most) break;
    std::this_thread::sleep_for(nap);
  }
  const std::size_t head = bytes.size();
  bytes.resize(head + sizeof chunk);
  std::memcpy(bytes.data() + head, &chunk, sizeof chunk);
  sending_.push_back(std::make_unique<Sending>());
  Sending& sending = *sending_.back();
  sending.bytes = std::move(bytes);
  require(MPI_Isend(sending.bytes.data(), static_cast<int>(sending.bytes.size()), MPI_BYTE, 0, result_tag,
                    MPI_COMM_WORLD, &sending.request));
}

bool Team::is_stopped() {
  int source = 0;
  int size = 0;
  stopped_ = stopped_ || (has_mpi_ && rank_ > 0 && has_arrived(stop_tag, 0, source, size));
  return stopped_;
}

void Team::finish() {
  while (!std::all_of(sending_.begin(), sending_.end(),
                      [](const auto& sending) { return sending->is_done(); })) {
    std::this_thread::sleep_for(nap);
  }
  require(MPI_Send(nullptr, 0, MPI_BYTE, 0, finish_tag, MPI_COMM_WORLD));
}

bool Team::have_all_finished() {
  int source = 0;
  int size = 0;
  while (finished_ < size_ - 1 && has_arrived(finish_tag, MPI_ANY_SOURCE, source, size)) {
    require(MPI_Recv(nullptr, 0, MPI_BYTE, source, finish_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE));
    ++finished_;
  }
  return finished_ == size_ - 1;
}

}  // namespace hybrid_sphere::study
