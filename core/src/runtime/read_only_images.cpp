#include "stillpoint/runtime/read_only_images.hpp"

#include <sys/mman.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <new>
#include <type_traits>

#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

/// Read by a signal handler: no lock, no memory of its own. Images that find no place in it are
/// read-only all the same, but nobody knows that they are images.
class AddressTable {
 public:
  void add(const void* begin, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    for (Range& range : ranges_) {
      if (range.begin != 0) continue;
      range.end = reinterpret_cast<std::uintptr_t>(begin) + bytes;
      range.begin = reinterpret_cast<std::uintptr_t>(begin);
      return;
    }
  }
  void remove(const void* begin) {
    const std::lock_guard lock(mutex_);
    for (Range& range : ranges_)
      if (range.begin == reinterpret_cast<std::uintptr_t>(begin)) range.begin = 0;
  }
  bool contains(const void* address) const {
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    for (const Range& range : ranges_)
      if (range.begin != 0 && at >= range.begin && at < range.end) return true;
    return false;
  }

 private:
  struct Range {
    std::atomic<std::uintptr_t> begin{0};  // 0: free
    std::atomic<std::uintptr_t> end{0};
  };
  std::mutex mutex_;
  std::array<Range, 4096> ranges_;  // written with mutex_ held
};

// Made at compile time and never destroyed: for signal handlers at any time, and for images that
// outlive static objects.
constinit AddressTable table;
static_assert(std::is_trivially_destructible_v<AddressTable>);

/// Pages of their own for each image.
class PageAllocator final : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag, cv::UMatUsageFlags) const override {
    std::size_t bytes = CV_ELEM_SIZE(type);
    for (int i = dimensions - 1; i >= 0; --i) {
      if (step) step[i] = bytes;
      bytes *= static_cast<std::size_t>(sizes[i]);
    }
    if (data) throw std::bad_alloc();  // memory of somebody else
    auto* result = new cv::UMatData(this);
    void* pages =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    result->data = result->origdata = static_cast<unsigned char*>(pages);
    result->size = bytes;
    table.add(pages, bytes);
    return result;
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag, cv::UMatUsageFlags) const override {
    return data != nullptr;
  }
  void deallocate(cv::UMatData* data) const override {
    if (!data) return;
    table.remove(data->origdata);
    ::munmap(data->origdata, data->size);
    delete data;
  }
};

cv::Mat read_only(const cv::Mat& image) {
  static PageAllocator& pages = *new PageAllocator;  // images may outlive static objects
  if (image.empty()) return image;
  cv::Mat copy;
  copy.allocator = &pages;
  image.copyTo(copy);
  if (copy.u->currAllocator != &pages ||
      ::mprotect(copy.data, copy.total() * copy.elemSize(), PROT_READ) != 0)
    throw Error(Fault::kStage, "there is no memory for images that cannot be written to", "",
                "run without 'validate: full'");
  copy.allocator = nullptr;  // of what is made of this header later
  return copy;
}

}  // namespace

Frame with_read_only_images(Frame frame) {
  frame.bgr = read_only(frame.bgr);
  frame.gray = read_only(frame.gray);
  frame.depth = read_only(frame.depth);
  return frame;
}

bool in_read_only_image(const void* address) { return table.contains(address); }

}  // namespace stillpoint
