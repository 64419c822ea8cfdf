// Structs that ranks tell each other of, named member by member as for archives.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/communicator.h"
#include "engine/archive.h"

namespace trocar {

// All ranks' items in rank order, on every rank; visit(archive, T) as in archive.h. Collective.
template <class T>
std::vector<T> all_gather_items(const Communicator& communicator, const std::vector<T>& mine) {
  Saver save;
  for (const T& item : mine) save(item);
  const std::vector<std::byte> bytes = save.take();
  const auto* const from = reinterpret_cast<const char*>(bytes.data());
  std::vector<T> all;
  for (const std::string& of_rank : communicator.all_gather(std::string(from, from + bytes.size())))
    for (Loader load(std::as_bytes(std::span(of_rank))); !load.is_at_end();)
      load(all.emplace_back());
  return all;
}

}  // namespace trocar
