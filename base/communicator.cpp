// Ranks by MPI. The only file that sees <mpi.h>.
#include "base/communicator.h"

#define OMPI_SKIP_MPICXX
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <thread>
#include <utility>

#include "base/check.h"

namespace trocar {

// MPI is done with a message only when the other rank has looked, so that a wait for it would hold
// up whoever is ahead: what is sent keeps its room until the exchange after the next. By then a
// neighbour has answered, and so has looked.
struct Communicator::Handle {
  struct Sends {
    std::vector<double> values;
    std::vector<MPI_Request> requests;
  };
  struct Group {
    std::vector<int> ranks;
    Communicator communicator;  // without a handle on other ranks
  };
  MPI_Comm group = MPI_COMM_NULL;
  std::vector<std::unique_ptr<Group>> groups;  // the last one was asked for last
  std::vector<MPI_Request> receives;
  std::array<Sends, 2> sends;  // of the exchange before the last, and the last
};

namespace {

constexpr int exchange_tag = 1, group_tag = 2;
// Up to here a message's bytes go at once, in place of an offer that is answered: between ranks
// that share memory 8 kB take 1.4 in place of 3.0 us both ways; at 32 kB it makes no difference.
constexpr const char* bytes_at_once = "32768";

// MPI counts with int.
constexpr std::size_t most_bytes_at_once = std::size_t{1} << 30;
int count_of(std::size_t n) {
  CHECK_OP(n, <=, static_cast<std::size_t>(std::numeric_limits<int>::max()));
  return static_cast<int>(n);
}

// Doubles as integers in the same order, so that min and max do not depend on the order of ranks:
// -0 < +0.
std::uint64_t ordered_bits(double value) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

double from_ordered_bits(std::uint64_t bits) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return std::bit_cast<double>((bits & sign) != 0 ? bits ^ sign : ~bits);
}

bool is_mpi_running() {
  int is_initialized = 0;
  int is_finalized = 0;
  MPI_Initialized(&is_initialized);
  MPI_Finalized(&is_finalized);
  return is_initialized != 0 && is_finalized == 0;
}

// MPI_Waitall spins for ever: with fewer free cores than ranks and picture threads it takes the
// core from the very rank that it waits for (liver scene, 2 ranks and drawing on 2 busy cores: 290
// s of 360 s). Spins for about as long as a message takes, then sleeps between looks.
void wait_politely(std::vector<MPI_Request>& requests) {
  constexpr int spins = 2000;
  int is_done = 0;
  for (int k = 0; k < spins && !is_done; ++k)
    MPI_Testall(count_of(requests.size()), requests.data(), &is_done, MPI_STATUSES_IGNORE);
  while (!is_done) {
    std::this_thread::sleep_for(std::chrono::microseconds(10));
    MPI_Testall(count_of(requests.size()), requests.data(), &is_done, MPI_STATUSES_IGNORE);
  }
  requests.clear();  // keeps its memory
}

// Where each rank's part begins in the concatenation; one entry more than ranks.
std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets(counts.size() + 1, 0);
  std::size_t total = 0;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    total += static_cast<std::size_t>(counts[r]);
    offsets[r + 1] = count_of(total);
  }
  return offsets;
}

std::vector<int> all_counts(MPI_Comm group, int n_ranks, int n_own) {
  std::vector<int> counts(static_cast<std::size_t>(n_ranks));
  MPI_Allgather(&n_own, 1, MPI_INT, counts.data(), 1, MPI_INT, group);
  return counts;
}

}  // namespace

Communicator::Communicator() = default;
Communicator::~Communicator() = default;
Communicator::Communicator(Communicator&&) noexcept = default;
Communicator& Communicator::operator=(Communicator&&) noexcept = default;

Traffic Communicator::traffic() const {
  Traffic all = traffic_;
  if (!handle_) return all;
  for (const auto& group : handle_->groups)
    all.n_collectives += group->communicator.traffic_.n_collectives;
  return all;
}

std::size_t Communicator::n_groups() const {
  if (!handle_) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(
      handle_->groups, [](const auto& group) { return group->communicator.handle_ != nullptr; }));
}

Communicator Communicator::make_group(std::span<const int> ranks) const {
  Communicator made;
  if (ranks.size() == 1 || !std::ranges::binary_search(ranks, rank_)) return made;
  MPI_Group all = MPI_GROUP_NULL, some = MPI_GROUP_NULL;
  MPI_Comm_group(handle_->group, &all);
  MPI_Group_incl(all, count_of(ranks.size()), ranks.data(), &some);
  made.handle_ = std::make_unique<Handle>();
  MPI_Comm_create_group(handle_->group, some, group_tag, &made.handle_->group);
  MPI_Group_free(&some);
  MPI_Group_free(&all);
  MPI_Comm_rank(made.handle_->group, &made.rank_);
  made.size_ = count_of(ranks.size());
  return made;
}

// Of a group, by all of its ranks alike.
void Communicator::free_group() {
  if (!handle_) return;
  for (Handle::Sends& sends : handle_->sends) wait_politely(sends.requests);
  MPI_Comm_free(&handle_->group);
}

const Communicator* Communicator::group(std::span<const int> ranks) {
  if (std::cmp_equal(ranks.size(), size_)) return this;
  auto& groups = handle_->groups;
  const auto known = std::ranges::find_if(
      groups, [&](const auto& group) { return std::ranges::equal(group->ranks, ranks); });
  if (known != groups.end()) {
    std::rotate(known, known + 1, groups.end());
  } else {
    // All ranks know of all groups, so that those of one free it at the same moment.
    if (groups.size() == most_groups) {
      traffic_.n_collectives += groups.front()->communicator.traffic_.n_collectives;
      groups.front()->communicator.free_group();
      groups.erase(groups.begin());
    }
    groups.push_back(std::make_unique<Handle::Group>(
        Handle::Group{{ranks.begin(), ranks.end()}, make_group(ranks)}));
  }
  return std::ranges::binary_search(ranks, rank_) ? &groups.back()->communicator : nullptr;
}

void Communicator::barrier() const {
  ++traffic_.n_collectives;
  if (handle_) MPI_Barrier(handle_->group);
}

double Communicator::all_min(double value) const {
  ++traffic_.n_collectives;
  std::uint64_t least = value != value ? 0 : ordered_bits(value);
  if (handle_) MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT64_T, MPI_MIN, handle_->group);
  return least == 0 ? std::numeric_limits<double>::quiet_NaN() : from_ordered_bits(least);
}

std::int32_t Communicator::lowest(std::int32_t number) const {
  ++traffic_.n_collectives;
  std::uint32_t least =
      number < 0 ? std::numeric_limits<std::uint32_t>::max() : static_cast<std::uint32_t>(number);
  if (handle_) MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT32_T, MPI_MIN, handle_->group);
  return static_cast<std::int32_t>(least);
}

double Communicator::all_max(double value) const {
  ++traffic_.n_collectives;
  constexpr std::uint64_t nan_key = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t greatest = value != value ? nan_key : ordered_bits(value);
  if (handle_) MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_UINT64_T, MPI_MAX, handle_->group);
  return greatest == nan_key ? std::numeric_limits<double>::quiet_NaN()
                             : from_ordered_bits(greatest);
}

std::uint64_t Communicator::all_sum(std::uint64_t value) const {
  all_sum(std::span(&value, 1));
  return value;
}

void Communicator::all_sum(std::span<std::uint64_t> values) const {
  ++traffic_.n_collectives;
  if (!handle_) return;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), count_of(values.size()), MPI_UINT64_T, MPI_SUM,
                handle_->group);
}

void Communicator::broadcast(std::vector<std::byte>& bytes, int root) const {
  ++traffic_.n_collectives;
  CHECK(root >= 0 && root < size_);
  if (!handle_) return;
  std::uint64_t n_bytes = bytes.size();
  std::vector<MPI_Request> request(1);
  MPI_Ibcast(&n_bytes, 1, MPI_UINT64_T, root, handle_->group, request.data());
  wait_politely(request);  // the root may be at work
  bytes.resize(n_bytes);
  for (std::size_t first = 0; first < n_bytes; first += most_bytes_at_once)
    MPI_Bcast(bytes.data() + first, count_of(std::min(most_bytes_at_once, n_bytes - first)),
              MPI_BYTE, root, handle_->group);
}

template <class T>
static std::vector<T> all_gather_in(MPI_Comm group, int size, std::span<const T> values,
                                    MPI_Datatype type) {
  const int n_own = count_of(values.size());
  const std::vector<int> counts = all_counts(group, size, n_own);
  const std::vector<int> offsets = offsets_of(counts);
  std::vector<T> all(static_cast<std::size_t>(offsets.back()));
  MPI_Allgatherv(values.data(), n_own, type, all.data(), counts.data(), offsets.data(), type,
                 group);
  return all;
}

std::vector<double> Communicator::all_gather(std::span<const double> values) const {
  ++traffic_.n_collectives;
  if (!handle_) return {values.begin(), values.end()};
  return all_gather_in(handle_->group, size_, values, MPI_DOUBLE);
}

std::vector<std::byte> Communicator::all_gather(std::span<const std::byte> bytes) const {
  ++traffic_.n_collectives;
  if (!handle_) return {bytes.begin(), bytes.end()};
  return all_gather_in(handle_->group, size_, bytes, MPI_BYTE);
}

std::vector<double> Communicator::gather(std::span<const double> values) const {
  ++traffic_.n_collectives;
  if (!handle_) return {values.begin(), values.end()};
  const int n_own = count_of(values.size());
  const std::vector<int> counts = all_counts(handle_->group, size_, n_own);
  const std::vector<int> offsets = offsets_of(counts);
  std::vector<double> all(is_root() ? static_cast<std::size_t>(offsets.back()) : 0);
  MPI_Gatherv(values.data(), n_own, MPI_DOUBLE, all.data(), counts.data(), offsets.data(),
              MPI_DOUBLE, 0, handle_->group);
  return all;
}

std::vector<std::string> Communicator::all_gather(const std::string& text) const {
  ++traffic_.n_collectives;
  if (!handle_) return {text};
  const int n_own = count_of(text.size());
  const std::vector<int> counts = all_counts(handle_->group, size_, n_own);
  const std::vector<int> offsets = offsets_of(counts);
  std::string all(static_cast<std::size_t>(offsets.back()), '\0');
  MPI_Allgatherv(text.data(), n_own, MPI_CHAR, all.data(), counts.data(), offsets.data(), MPI_CHAR,
                 handle_->group);
  std::vector<std::string> texts;
  for (std::size_t r = 0; r < counts.size(); ++r)
    texts.push_back(
        all.substr(static_cast<std::size_t>(offsets[r]), static_cast<std::size_t>(counts[r])));
  return texts;
}

std::string Communicator::first_text(const std::string& text) const {
  ++traffic_.n_collectives;
  if (!handle_) return text;
  int first = text.empty() ? size_ : rank_;
  std::vector<MPI_Request> request(1);
  MPI_Iallreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, handle_->group, request.data());
  wait_politely(request);  // some may be at work
  if (first == size_) return "";
  const auto* own = reinterpret_cast<const std::byte*>(text.data());
  std::vector<std::byte> bytes(own, own + text.size());
  broadcast(bytes, first);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Without MPI the only neighbour is the rank itself: what it sends is what it receives.
static void exchange_with_self(std::span<const ExchangeMessage> messages) {
  for (const ExchangeMessage& message : messages) {
    CHECK_OP(message.rank, ==, 0);
    CHECK_OP(message.send.size(), ==, message.receive.size());
    std::copy(message.send.begin(), message.send.end(), message.receive.begin());
  }
}

namespace {

void receive(MPI_Comm group, std::span<const ExchangeMessage> messages,
             std::vector<MPI_Request>& requests) {
  for (const ExchangeMessage& message : messages)
    MPI_Irecv(message.receive.data(), count_of(message.receive.size()), MPI_DOUBLE, message.rank,
              exchange_tag, group, &requests.emplace_back());
}

void send(MPI_Comm group, std::span<const ExchangeMessage> messages,
          std::vector<MPI_Request>& requests) {
  for (const ExchangeMessage& message : messages)
    MPI_Isend(message.send.data(), count_of(message.send.size()), MPI_DOUBLE, message.rank,
              exchange_tag, group, &requests.emplace_back());
}

}  // namespace

std::span<double> Communicator::room_to_send(std::size_t n) {
  if (handle_) {
    std::swap(handle_->sends[0], handle_->sends[1]);
    wait_politely(handle_->sends[1].requests);
  }
  std::vector<double>& room = handle_ ? handle_->sends[1].values : alone_;
  room.resize(n);
  return room;
}

void Communicator::start_exchange(std::span<const ExchangeMessage> messages) {
  ++traffic_.n_exchanges;
  traffic_.n_messages += messages.size();
  for (const ExchangeMessage& message : messages) traffic_.n_bytes += message.send.size_bytes();
  if (!handle_) return exchange_with_self(messages);
  CHECK(handle_->receives.empty());  // the exchange before this one is finished
  receive(handle_->group, messages, handle_->receives);
  CHECK(handle_->sends[1].requests.empty());  // room was asked for
  send(handle_->group, messages, handle_->sends[1].requests);
}

void Communicator::finish_exchange() {
  if (handle_) wait_politely(handle_->receives);
}

MpiSession::MpiSession(int* argc, char*** argv) {
  // hwloc, which Open MPI asks about the machine, looks for X displays by name: five seconds each
  // where no name service answers.
  setenv("HWLOC_COMPONENTS", "-gl", 0);
  for (const char* transport : {"OMPI_MCA_btl_vader_eager_limit", "OMPI_MCA_btl_sm_eager_limit"})
    setenv(transport, bytes_at_once, 0);  // of Open MPI up to 4, and from 5 on
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
  CHECK_OP(provided, >=, static_cast<int>(MPI_THREAD_FUNNELED));
  world_.handle_ = std::make_unique<Communicator::Handle>();
  world_.handle_->group = MPI_COMM_WORLD;
  MPI_Comm_rank(MPI_COMM_WORLD, &world_.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &world_.size_);
}

MpiSession::~MpiSession() {
  // MPI_Finalize waits for all ranks: where an error drives this rank out alone, it would wait for
  // ever.
  CHECK(world_.size() == 1 || std::uncaught_exceptions() == 0);
  for (Communicator::Handle::Sends& sends : world_.handle_->sends) wait_politely(sends.requests);
  MPI_Finalize();
}

bool has_other_ranks() {
  if (!is_mpi_running()) return false;
  int n_ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  return n_ranks > 1;
}

void abort_all_ranks(int exit_code) {
  std::fflush(nullptr);
  if (has_other_ranks()) MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

std::string mpi_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string version(text, static_cast<std::size_t>(length));
  return version.substr(0, version.find_first_of(",\n"));
}

}  // namespace trocar
