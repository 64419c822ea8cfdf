#include "engine/event_log.h"

#include <algorithm>

#include "base/log.h"
#include "base/number_text.h"

namespace trocar {

static const std::string& add_event(Simulation& s, double time, const std::string& event) {
  return s.log.events.emplace_back(with_decimals(time, 3) + " s: " + event);
}

void note_event(Simulation& s, double time, const std::string& event) {
  log_info(add_event(s, time, event));
}

void warn_event(Simulation& s, double time, const std::string& event) {
  log_warning(add_event(s, time, event));
}

bool is_told(const Simulation& s, std::string_view part) {
  return std::ranges::any_of(s.log.events, [&](const std::string& event) {
    return event.find(part) != std::string::npos;
  });
}

}  // namespace trocar
