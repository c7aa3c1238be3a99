// What a parallel call orders, said to ThreadSanitizer: the task library is not instrumented, so that it would report
// every task's reading of what the caller wrote before. Without that sanitizer nothing of this is left.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define ALHAZEN_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define ALHAZEN_THREAD_SANITIZER 1
#endif
#endif

#ifdef ALHAZEN_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace alhazen {

/// Around one parallel call, which must end before it does:
///     const ForkJoin order;
///     tbb::parallel_for(0, n, order.task([&](int i) { ... }));
/// Every task comes after the call of task() and before the destruction; tasks are not ordered among themselves, so
/// that races between them are still found.
class ForkJoin {
 public:
  ForkJoin() = default;
  ~ForkJoin() { acquire(&join_); }
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;

  /// `body` by reference: the copies that the task library makes of a task are none of ours.
  template <class Body>
  struct Task {
    const Body* body;
    template <class... Arguments>
    void operator()(Arguments... arguments) const {
      acquire(&fork_);
      (*body)(arguments...);
      release(&join_);
    }
  };

  /// `body` must live until the parallel call returns, as a temporary in the call does.
  template <class Body>
  [[nodiscard]] Task<Body> task(const Body& body) const {
    release(&fork_);
    return {&body};
  }

 private:
#ifdef ALHAZEN_THREAD_SANITIZER
  static void acquire(char* sync) { __tsan_acquire(sync); }
  static void release(char* sync) { __tsan_release(sync); }
#else
  static void acquire(char*) {}
  static void release(char*) {}
#endif
  static inline char fork_ = 0, join_ = 0;  // their addresses are what counts
};

}  // namespace alhazen
