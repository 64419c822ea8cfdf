// Structs that ranks tell each other of, named member by member as for archives.
#pragma once

#include <span>
#include <vector>

#include "base/communicator.h"
#include "engine/archive.h"

namespace trocar {

// All ranks' items in rank order, on every rank; visit(archive, T) as in archive.h. Collective.
template <class T>
std::vector<T> all_gather_items(const Communicator& communicator, const std::vector<T>& mine) {
  Saver save;
  for (const T& item : mine) save(item);
  const std::vector<std::byte> bytes =
      communicator.all_gather(std::span<const std::byte>(save.take()));
  std::vector<T> all;
  for (Loader load(bytes); !load.is_at_end();) load(all.emplace_back());
  return all;
}

}  // namespace trocar
