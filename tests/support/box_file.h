// A box as a surface file, for instruments of users.
#pragma once

#include <fstream>
#include <string>

#include "base/vec.h"

namespace trocar {

inline void write_box(const std::string& file, const Vec3& low, const Vec3& high) {
  std::ofstream out(file);
  for (const double z : {low.z(), high.z()})
    for (const double y : {low.y(), high.y()})
      for (const double x : {low.x(), high.x()}) out << "v " << x << ' ' << y << ' ' << z << '\n';
  out << "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\n"
         "f 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";
}

}  // namespace trocar
