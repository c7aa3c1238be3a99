// Loops whose turns run in parallel and fail as if they had run in order.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <exception>
#include <vector>

#include "core/fork_join.h"

namespace alhazen {

/// body(0) to body(n - 1); then throws what the first of them threw that did.
template <class Body>
void for_each_in_parallel(size_t n, const Body& body) {
  std::vector<std::exception_ptr> thrown(n);
  {
    const ForkJoin order;
    tbb::parallel_for(size_t{0}, n, order.task([&](size_t i) {
      try {
        body(i);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
    }));
  }
  for (const std::exception_ptr& e : thrown)
    if (e) std::rethrow_exception(e);
}

}  // namespace alhazen
