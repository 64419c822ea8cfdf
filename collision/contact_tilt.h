// What contact adds to the stiffness of triangles that it presses on.
#pragma once

#include <cstdint>

#include "collision/contact_set.h"

namespace trocar {

// A tool that is curved with the radius R touches a triangle further up as that tilts, so that its
// force F turns it back: to second order the gap has -R/2 |grad u|^2 of the displacement u along
// the normal, a stiffness F R grad N_a . grad N_b. Of the mean forces over the frame's n_steps, the
// square of the highest frequency that these stiffnesses alone give the set's nodes; 0 on ranks
// that don't count the reactions. [1/s^2]
double tilt_frequency2(const ContactDetector& detector, std::int64_t n_steps,
                       const ContactSet& set);

}  // namespace trocar
