// ParaView files: VTU with inline base64, zlib blocks and UInt64 headers, and the PVD that makes a
// time series of them (topology may change).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// A field of `width` doubles a node or an element.
struct VtuField {
  std::string name;
  int width = 1;
  std::span<const double> values;
};

// Points at reference position + displacement (field "displacement" is not added by itself: pass
// x). The regions stand in the cell array "region". Throws MachineError if the file can't be
// written.
void write_vtu(const Mesh& mesh, std::span<const Vec3> x, std::span<const VtuField> nodal,
               std::span<const VtuField> elemental, const std::string& file);

struct PvdEntry {
  double time = 0;   // [s]
  std::string file;  // relative to the PVD
};
void write_pvd(std::span<const PvdEntry> entries, const std::string& file);

}  // namespace trocar
