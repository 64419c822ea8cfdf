// Contacts made by hand, on nodes that one rank owns, for the tests of the force law.
#pragma once

#include <vector>

#include "collision/contact_solve.h"

namespace trocar {

Part whole_part(std::int32_t n_nodes);

// Of a field (n_nodes * 3).
Vec3 node_of(const std::vector<double>& field, std::size_t i);

// A node on a tool that fills the half-space below `point`, normal n (from tool to tissue).
Contact node_contact(std::int32_t node, const Vec3& n, const Vec3& point = Vec3::Zero());

// Nodes with contacts on one tool, integrated by central differences (velocity half a step behind).
struct ContactBench {
  std::vector<Vec3> X;
  std::vector<double> mass, u, v, u_next, force;
  ContactOptions options;
  double dt = 1e-4;
  std::vector<ToolMotion> tools = std::vector<ToolMotion>(1);
  Part part;
  ContactDetector detector{
      std::vector<ToolShape>(3, {{{.points = {Vec3(0, 0, 1e3)}}}})};  // far off
  ContactSet set;

  ContactBench(std::vector<Vec3> X_, std::vector<double> mass_);

  // held: components of each node, those of further nodes none.
  void prepare(const std::vector<Contact>& contacts, std::vector<std::uint8_t> held = {},
               const std::vector<TissuePair>& tissue = {});
  ContactStep contact_step() const { return {.tools = tools, .dt = dt, .response = dt * dt}; }
  void place();
  // Contact forces of a step from u to u_next.
  void add_forces();
  // A step with the bodies' own forces `own` (n * 3) [N].
  void step(const std::vector<double>& own);
  void step(const Vec3& gravity);
  Vec3 reaction() const;
};

}  // namespace trocar
