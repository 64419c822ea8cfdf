// What ranks say to each other. <mpi.h> is seen by communicator.cpp alone.
// Every reduction here gives the same bits for any number of ranks: min, max, and sums of integers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace trocar {

// One neighbour's part of an exchange. `send` lies in room_to_send; what is received lives until
// finish_exchange.
struct ExchangeMessage {
  int rank = 0;
  std::span<const double> send;
  std::span<double> receive;
};

// What this rank has taken part in.
struct Traffic {
  std::uint64_t n_collectives = 0, n_exchanges = 0, n_messages = 0, n_bytes = 0;  // sent
};

// A group of ranks. The default one is this process alone and needs no MPI.
class Communicator {
 public:
  Communicator();
  ~Communicator();
  Communicator(Communicator&&) noexcept;
  Communicator& operator=(Communicator&&) noexcept;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_root() const { return rank_ == 0; }
  // With that of groups.
  Traffic traffic() const;

  // These ranks, ascending, as a communicator of their own, in which they have the same order; null
  // on the others. It lives until most_groups others have been asked for after it: making one takes
  // a message or two, and MPI has only so many. Collective.
  const Communicator* group(std::span<const int> ranks);
  static constexpr std::size_t most_groups = 8;
  // That MPI has for this rank now.
  std::size_t n_groups() const;

  // Collective: every rank calls these with the same kind of argument.
  // A NaN on any rank makes the minimum and the maximum NaN; -0 counts as less than +0.
  void barrier() const;
  double all_min(double value) const;
  double all_max(double value) const;
  // The least number >= 0 of all ranks', -1 if there is none.
  std::int32_t lowest(std::int32_t number) const;
  std::uint64_t all_sum(std::uint64_t value) const;  // modulo 2^64
  void all_sum(std::span<std::uint64_t> values) const;
  // Bytes of `root` to everyone; resizes on the others.
  void broadcast(std::vector<std::byte>& bytes, int root = 0) const;
  // Concatenation of every rank's values in rank order, on every rank / on the root (empty
  // elsewhere).
  std::vector<double> all_gather(std::span<const double> values) const;
  std::vector<std::byte> all_gather(std::span<const std::byte> bytes) const;
  std::vector<double> gather(std::span<const double> values) const;
  std::vector<std::string> all_gather(const std::string& text) const;
  // The first (lowest) rank whose `text` is not empty decides: its text, on every rank; "" if all
  // are empty.
  std::string first_text(const std::string& text) const;

  // Non-blocking neighbour exchange, one at a time; no allocation after the first two of a size.
  // First the room for what all messages send, which stays as it is until the exchange after the
  // next.
  std::span<double> room_to_send(std::size_t n);
  void start_exchange(std::span<const ExchangeMessage> messages);
  void finish_exchange();

 private:
  friend class MpiSession;
  struct Handle;
  Communicator make_group(std::span<const int> ranks) const;
  void free_group();
  std::unique_ptr<Handle> handle_;
  std::vector<double> alone_;  // room_to_send without MPI
  int rank_ = 0;
  int size_ = 1;
  mutable Traffic traffic_;
};

// MPI from main's first line to its last. Works without mpirun (one rank). With several ranks no
// exception may leave its life: catch inside, and end the others with abort_all_ranks.
class MpiSession {
 public:
  MpiSession(int* argc, char*** argv);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
  Communicator& world() { return world_; }

 private:
  Communicator world_;
};

// Whether MPI is running with more than this rank.
bool has_other_ranks();
// Ends every rank at once with this exit code (MPI_Abort); plain exit where MPI is not running.
[[noreturn]] void abort_all_ranks(int exit_code);

// Version line of the MPI library, e.g. "Open MPI v4.1.4". Needs no session.
std::string mpi_version();

}  // namespace trocar
