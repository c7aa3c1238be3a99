#include "loaders/image_library.h"

#include <dlfcn.h>

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

/// The one loading that there is, begun if need be. At the program's end its destructor waits for a thread that loads.
std::shared_future<const ImageLibrary*> loading(std::launch how) {
  static std::mutex mutex;
  static std::shared_future<const ImageLibrary*> future;
  const std::lock_guard lock(mutex);
  if (!future.valid()) future = std::async(how, load).share();
  return future;
}

}  // namespace

const ImageLibrary& image_library() { return *loading(std::launch::deferred).get(); }

void preload_image_library() { (void)loading(std::launch::async); }

}  // namespace alhazen
