// What rank 0 alone does for all ranks, or each for itself. What goes wrong there is thrown on
// every rank, so that all can leave in good order.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.h"
#include "base/error.h"

namespace trocar {

// Runs `act` on the ranks that are asked to. The InputErrors of the first to fail are thrown on
// every rank, and anything else as a SharedMachineError. Collective.
template <class Act>
void share_trouble(const Communicator& communicator, bool is_asked, const Act& act) {
  constexpr char input = 'i', machine = 'm';  // stands before the sentence
  std::string trouble;
  if (is_asked) {
    try {
      act();
    } catch (const InputError& caught) {
      trouble = input + std::string(caught.what());
    } catch (const std::exception& caught) {
      trouble = machine + std::string(caught.what());
    }
  }
  trouble = communicator.first_text(trouble);
  if (trouble.empty()) return;
  if (trouble[0] == input) throw InputError(trouble.substr(1));
  throw SharedMachineError(trouble.substr(1));
}

template <class Act>
void on_root(const Communicator& communicator, const Act& act) {
  share_trouble(communicator, communicator.is_root(), act);
}

template <class Act>
void on_every_rank(const Communicator& communicator, const Act& act) {
  share_trouble(communicator, true, act);
}

// The same with what `read` returns, bytes, on every rank. Collective.
template <class Read>
std::vector<std::byte> read_on_root(const Communicator& communicator, const Read& read) {
  std::vector<std::byte> bytes;
  on_root(communicator, [&] { bytes = read(); });
  communicator.broadcast(bytes);
  return bytes;
}

}  // namespace trocar
