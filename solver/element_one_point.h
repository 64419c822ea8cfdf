// What the loops over blocks ask of an element: strains of its points and what it keeps to the
// stash (stash.h), forces out of it. For elements with one stress point: Element has strain(value,
// u, kept) that returns the mean gradient H and keeps what else it needs, forces(value, kept, V P,
// f), and where something is kept, prepare(value, kept), before u is known, and
// hourglass_energy(value, kept). Where Element::reads_positions of a pack, prepare(X, kept) instead
// takes reference positions of the corners (Element::Aligned: edges); values_spared_in_single and
// kept_added_in_single say by how much the numbers of single precision differ.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/stash.h"
#include "solver/tensor.h"

namespace trocar {

// What computes rows of boxes along the axes (row_order.h).
template <class Element>
struct AlignedOf {
  using type = Element;
};

template <class Element>
struct OnePoint {
  static constexpr Formulation formulation = Element::formulation;
  static constexpr LawKind law = LawKind::local;
  static constexpr int n_corners = Element::n_corners;
  static constexpr int n_values = Element::n_values;
  static constexpr int n_points = 1;
  static constexpr int n_kept = Element::n_kept;
  static constexpr int values_spared_in_single = [] {
    if constexpr (requires { Element::values_spared_in_single; })
      return Element::values_spared_in_single;
    return 0;
  }();
  static constexpr int kept_added_in_single = [] {
    if constexpr (requires { Element::kept_added_in_single; }) return Element::kept_added_in_single;
    return 0;
  }();
  // Of an aligned one: whether its kernels read a value.
  static constexpr bool is_read(int value) requires requires { Element::is_read(0); }
  { return Element::is_read(value); }
  template <class Pack>
  static constexpr bool reads_positions = [] {
    if constexpr (requires { Element::template reads_positions<Pack>; })
      return Element::template reads_positions<Pack>;
    return false;
  }();

  template <class Pack>
  [[gnu::always_inline]] static void prepare(const BlockValues<Pack>& value,
                                             const Stash<Pack>& stash) {
    if constexpr (n_kept > 0) {
      Element::prepare(value, kept(stash));
      // Read again where it is used: kept in registers, it would push out the displacements.
      asm volatile("" ::: "memory");
    }
  }

  template <class Pack>
  [[gnu::always_inline]] static void prepare(Pack (&X)[n_corners][3], const Stash<Pack>& stash) {
    Element::prepare(X, kept(stash));
    asm volatile("" ::: "memory");  // likewise
  }
  template <class Pack>
  [[gnu::always_inline]] static void prepare(const Pack (&edge)[3], const Stash<Pack>& stash) {
    Element::prepare(edge, kept(stash));
    asm volatile("" ::: "memory");  // likewise
  }

  template <class Pack>
  [[gnu::always_inline]] static void strain(const BlockValues<Pack>& value,
                                            const Pack (&u)[n_corners][3],
                                            const Stash<Pack>& stash) {
    stash.put_tensor(0, Element::strain(value, u, kept(stash)));
  }

  // What corner forces are made of, of elements that have it (hex8_modes.h). [N]
  template <class Pack, int n_modes>
  [[gnu::always_inline]] static void force_modes(const BlockValues<Pack>& value,
                                                 const Stash<Pack>& stash, Pack (&w)[3][n_modes]) {
    Element::force_modes(value, kept(stash), stash.get_tensor(0), w);
  }

  // f: corner forces. [N]
  template <class Pack>
  [[gnu::always_inline]] static void force(const BlockValues<Pack>& value, const Stash<Pack>& stash,
                                           Pack (&f)[n_corners][3]) {
    Element::forces(value, kept(stash), stash.get_tensor(0), f);
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack hourglass_energy(const BlockValues<Pack>& value,
                                                      const Stash<Pack>& stash) {
    if constexpr (n_kept > 0)
      return Element::hourglass_energy(value, kept(stash));
    else
      return zero_of(stash.get(0));
  }

 private:
  template <class Pack>
  [[gnu::always_inline]] static Stash<Pack> kept(const Stash<Pack>& stash) {
    return {stash.at + tensor_values * block_lanes<Pack>};
  }
};

template <class Element>
requires requires {
  typename Element::Aligned;
}
struct AlignedOf<OnePoint<Element>> {
  using type = OnePoint<typename Element::Aligned>;
};

}  // namespace trocar
