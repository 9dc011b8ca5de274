#include "simulation/out_of_memory.hpp"

#include <sys/mman.h>

#include <new>
#include <opencv2/core.hpp>

#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

Error out_of_memory() {
  return {Fault::kStage, "there is not enough memory for this scene", "simulation",
          "it takes less with smaller images, fewer threads, people and photographs"};
}

}  // namespace

void require_memory(std::size_t bytes) {
  void* pages = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) throw out_of_memory();
  ::munmap(pages, bytes);
}

void rethrow_named() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    throw out_of_memory();
  } catch (const cv::Exception& exception) {
    if (exception.code == cv::Error::StsNoMem) throw out_of_memory();
    throw;
  }
}

}  // namespace stillpoint::simulation
