#include "loaders/image_library.h"

#include <dlfcn.h>

#include <chrono>
#include <future>
#include <mutex>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr const char* kFile = "alhazen_images.so";  // found by the program's run path

const ImageLibrary* load() {
  // Never unloaded: its libraries start threads, and have handlers for the end of the program.
  void* library = dlopen(kFile, RTLD_LAZY | RTLD_LOCAL);
  const auto table =
      library ? reinterpret_cast<const ImageLibrary* (*)()>(dlsym(library, "alhazen_image_library")) : nullptr;
  if (table) return table();
  const char* reason = dlerror();
  throw Error(std::string("cannot load what reads and writes images other than .exr and .png: ") +
                  (reason ? reason : kFile) + "; it is installed in lib/alhazen beside the program's bin",
              ExitStatus::internal);
}

/// The one loading that there is, once it is begun.
struct Loading {
  std::mutex mutex;
  std::shared_future<const ImageLibrary*> library;
};
Loading& loading() {
  static Loading only;
  return only;
}

std::shared_future<const ImageLibrary*> begin(std::launch how) {
  const std::lock_guard lock(loading().mutex);
  if (!loading().library.valid()) loading().library = std::async(how, load).share();
  return loading().library;
}

}  // namespace

const ImageLibrary& image_library() { return *begin(std::launch::deferred).get(); }

void preload_image_library() { (void)begin(std::launch::async); }

void await_image_library() noexcept {
  const std::lock_guard lock(loading().mutex);
  // Loading that is deferred has no thread.
  if (loading().library.valid() && loading().library.wait_for(std::chrono::seconds(0)) == std::future_status::timeout)
    loading().library.wait();
}

}  // namespace alhazen
