// A list of types to write out tables and tests over.
#pragma once

namespace trocar {

template <class... Types>
struct TypeList {
  static constexpr int size = sizeof...(Types);
};

}  // namespace trocar
