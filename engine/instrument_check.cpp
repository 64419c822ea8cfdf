#include "engine/instrument_check.h"

#include <cstdio>

#include "engine/frame_report.h"

namespace trocar {

void check_instruments_outside(const LoadedScene& loaded, double allowed, const std::string& what,
                               Simulation& s) {
  detect_contacts(*s.contact, s.tools, s.holds, s.view, FrameSpan{}, 0);
  const Contact* deepest = nullptr;
  for (const Contact& contact : s.contact->contacts)
    if (contact.gap < -allowed && (deepest == nullptr || contact.gap < deepest->gap))
      deepest = &contact;
  if (deepest == nullptr) return;
  char depth[40];
  std::snprintf(depth, sizeof depth, "%.3g m", -deepest->gap);
  const auto tool = static_cast<std::size_t>(deepest->tool);
  loaded.where.fail("instrument[" + std::to_string(tool) + "].path[0].position",
                    "\"" + s.tools[tool].name + "\" reaches " + depth + " into " + what);
}

}  // namespace trocar
