// Progressive cutting of tetrahedra by displacing existing nodes onto the swept surface (Serby,
// Harders and Szekely 2001, taken to 3D). Hexahedra: cut_hex.h.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cutting/blade_sweep.h"
#include "cutting/cut_constraints.h"
#include "cutting/cut_figures.h"
#include "cutting/cut_positions.h"
#include "cutting/cut_stroke.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// How nodes get onto the blade's surface and elements around them get their shapes back.
enum class CutStages : std::uint8_t {
  springs,               // displaced, then springs and Lennard-Jones particles, as in the plane
  springs_then_barrier,  // the same as far as elements stay valid, then descent on the barrier
  barrier                // descent on the barrier alone
};

struct CutTetOptions {
  // Of the local mean edge length: what the blade must sweep before the mesh is changed.
  double advance = 0.5;
  // Floor on the ratio least stable step after / before of the tetrahedra around (element bound; a
  // cube's tetrahedra have 1/sqrt(2) of its own). What would sink below it stops on its way to the
  // blade: the cut lies beside it there.
  double least_step_ratio = 0.75;
  // Where tissue is one element thick, edges get nodes that part it; no element's step bound sinks
  // below this part of the body's least one by that. 0: none are added.
  double split_step_ratio = 0.35;
  CutStages stages = CutStages::barrier;
};

// Of the mesh, and of the tetrahedra that the cutter sees in its place, if it has or had hexahedra.
struct CutterEdit : MeshEdit {
  MeshEdit tets;
  CutKnown along;  // what the stroke knows of the elements around what it opens
};

// One blade's cut from its entry into tissue to its exit.
class TetCutter {
 public:
  explicit TetCutter(const CutTetOptions& options);
  ~TetCutter();
  TetCutter(TetCutter&&) noexcept;

  // Looks at the whole mesh once; without it, the first advance does. From then on an advance costs
  // what it touches.
  void prepare(const Mesh& mesh);
  bool is_prepared(const Mesh& mesh) const;

  // Takes up what another cutter makes of `mesh`, which is before that edit: one that was prepared
  // stays so.
  void follow(const Mesh& mesh, const CutterEdit& edit);

  // Takes up the swept band; makes the edit once enough is swept (or is_last: the blade left or
  // stopped). The edit is empty while it waits; one that inserts nodes parts nothing yet: apply it
  // and advance again, the blade at rest where it is and is_last as before. Nodes of facets between
  // regions of the mesh stay on these. Deterministic in its arguments, as is what it asks of
  // `positions`. `figures` gets the figures of this edit.
  CutterEdit advance(const Mesh& mesh, PresentPositions& positions,
                     const CutConstraints& constraints, const BladeSweep& sweep, bool is_last,
                     CutFigures& figures);

  // Whether the swept band crosses an edge of the mesh, which no stroke takes up.
  bool meets(const Mesh& mesh, PresentPositions& positions, const BladeSweep& sweep);

  // Whether this stroke, or an earlier one, has crossed edges of an element of `mesh` ahead of X,
  // by a surface at most 60 degrees off the normal: the blade has been there, though nothing is
  // parted yet. Reference configuration.
  bool has_crossed_ahead(const Mesh& mesh, std::int32_t element, const Vec3& X, const Vec3& ahead,
                         const Vec3& normal) const;

  // A new stroke: forgets the front (faces that are open stay open).
  void start_stroke();

  // What the stroke leaves to others when it ends (cut_stroke.h); what another cutter's stroke has
  // left: one of this cutter that comes there goes on with it.
  CutLeft left() const;
  void take_over(const CutLeft& left);

  // All that a cut under way remembers, for checkpoints: with the same stroke another cutter goes
  // on to the same bits. Node and element numbers are global and survive edits.
  const CutStroke& stroke() const;
  void set_stroke(CutStroke stroke);

 private:
  struct Front;
  std::unique_ptr<Front> front_;
};

}  // namespace trocar
