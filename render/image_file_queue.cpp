#include "render/image_file.h"
#include "render/work_queue.h"

namespace trocar {

namespace {

constexpr std::size_t queue_length = 4;

struct PngJob {
  Image image;
  std::string file;
};

}  // namespace

struct PngQueue::Queue {
  WorkQueue<PngJob> work{queue_length, [](PngJob& job) { write_png(job.image, job.file); }};
};

PngQueue::PngQueue() : queue_(std::make_unique<Queue>()) {}
PngQueue::~PngQueue() = default;
PngQueue::PngQueue(PngQueue&&) noexcept = default;
void PngQueue::add(Image image, std::string file) {
  queue_->work.add({std::move(image), std::move(file)});
}
void PngQueue::finish() {
  queue_->work.finish();
}

}  // namespace trocar
