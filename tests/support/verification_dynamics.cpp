#include "verification_dynamics.h"

namespace trocar {

void forced_step(Body& body, double dt, const AddForce& add_force) {
  force(body);
  if (add_force) add_force(body);
  integrate(body.model, body.scratch, {}, dt, body.state);
}

void advance(Body& body, double t, double factor) {
  advance(body, t, factor, [](const Body&) {});
}

double order_between(double coarse, double fine) {
  return std::log2(std::abs(coarse) / std::abs(fine));
}

}  // namespace trocar
