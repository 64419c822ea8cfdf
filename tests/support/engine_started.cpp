#include "engine_started.h"

#include "base/log.h"
#include "base/threads.h"

namespace trocar {

Started::Started() = default;
Started::~Started() = default;

std::unique_ptr<Started> built(const std::string& text, const std::vector<std::string>& overrides) {
  start_log(0, true);
  set_thread_count(1);
  const TestFolder folder;
  auto started = std::make_unique<Started>();
  started->loaded = load_scene(write_text(folder.file("s.toml"), text), overrides);
  started->s = build(started->loaded, started->alone);
  return started;
}

}  // namespace trocar
