// What the loops over blocks ask of an element: strains of its points and what it keeps to the
// stash (stash.h), forces out of it. For elements with one stress point: Element has strain(value,
// u) with the mean gradient H and, of hexahedra, hourglass displacements q and gradients b;
// forces(value, strain, V P, f) and hourglass_energy(value, strain).
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/hourglass.h"
#include "solver/stash.h"
#include "solver/tensor.h"

namespace trocar {

template <class Element>
struct OnePoint {
  static constexpr Formulation formulation = Element::formulation;
  static constexpr LawKind law = LawKind::local;
  static constexpr int n_corners = Element::n_corners;
  static constexpr int n_values = Element::n_values;
  static constexpr int n_points = 1;
  static constexpr int n_kept = Element::n_kept;

  template <class Pack>
  using Strain = typename Element::template Strain<Pack>;

  template <class Pack>
  [[gnu::always_inline]] static void strain(const BlockValues<Pack>& value,
                                            const Pack (&u)[n_corners][3],
                                            const Stash<Pack>& stash) {
    const Strain<Pack> strain = Element::strain(value, u);
    stash.put_tensor(0, strain.H);
    if constexpr (n_kept > 0) {
      for (int k = 0; k < n_q; ++k) stash.put(tensor_values + k, strain.q[k / 3][k % 3]);
      for (int k = n_q; k < n_kept; ++k)
        stash.put(tensor_values + k, strain.b[(k - n_q) / 3][k % 3]);
    }
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
  static constexpr int n_q = 3 * n_hourglass_modes;  // ahead of b
  template <class Pack>
  [[gnu::always_inline]] static Strain<Pack> kept(const Stash<Pack>& stash) {
    Strain<Pack> strain;
    if constexpr (n_kept > 0) {
      for (int k = 0; k < n_q; ++k) strain.q[k / 3][k % 3] = stash.get(tensor_values + k);
      for (int k = n_q; k < n_kept; ++k)
        strain.b[(k - n_q) / 3][k % 3] = stash.get(tensor_values + k);
    }
    return strain;
  }
};

}  // namespace trocar
