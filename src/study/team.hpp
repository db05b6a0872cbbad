#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hybrid_sphere::study {

/// The processes that compute a study together, under mpirun. Rank 0 hands out chunks and keeps the results;
/// it computes, too. Without mpirun there is one rank, and MPI is not begun.
///
/// Calls throw std::runtime_error where MPI fails. No call waits for a rank that has died: mpirun ends them
/// all.
class Team {
 public:
  /// What a rank other than 0 has computed.
  struct Result {
    int rank;
    std::uint64_t chunk;
    std::vector<unsigned char> bytes;
  };
  static constexpr std::int64_t no_more = -1;

  /// Begins MPI if this process runs under mpirun.
  Team();
  /// Ends it.
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  static bool is_under_mpirun();
  /// Whether mpirun has made this process rank 0; known before MPI is begun.
  static bool is_first();

  /// Ends all ranks, as the others would wait for this one for ever.
  void abort(int exit_code);

  int rank() const { return rank_; }
  int size() const { return size_; }

  /// A text of each rank, on rank 0; elsewhere empty.
  std::vector<std::string> gather(const std::string& text);
  /// The number that rank 0 has. Ranks that wait for it do not keep their core busy.
  int from_first(int number);

  // Rank 0:
  std::optional<Result> receive();
  /// @param chunk  or no_more
  void assign(int rank, std::int64_t chunk);
  /// Asks all others to stop at once.
  void stop();
  /// Whether all others have sent all that they will; what has arrived is still to be received.
  bool have_all_finished();

  // Any other rank:
  /// The next chunk, or no_more; waits for it.
  std::int64_t next_chunk();
  /// Returns before the bytes have arrived, unless two results are on their way already.
  void send(std::uint64_t chunk, std::vector<unsigned char> bytes);
  bool is_stopped();
  /// Nothing more will be sent: waits until all results have arrived.
  void finish();

 private:
  struct Sending;

  bool has_arrived(int tag, int rank, int& source, int& size);

  int rank_ = 0;
  int size_ = 1;
  bool has_mpi_ = false;
  bool stopped_ = false;
  int finished_ = 0;
  std::vector<std::unique_ptr<Sending>> sending_;
};

}  // namespace hybrid_sphere::study
