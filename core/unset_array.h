// Arrays that nobody clears.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

namespace alhazen {

/// An array of plain values of which all but the first are not set: where mostly one of several counts, clearing the
/// others in vain would take its time.
template <class T, size_t n>
class UnsetArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  UnsetArray() { (*this)[0] = T{}; }
  [[nodiscard]] T* data() { return std::launder(reinterpret_cast<T*>(memory_)); }
  [[nodiscard]] const T* data() const { return std::launder(reinterpret_cast<const T*>(memory_)); }
  T& operator[](size_t i) { return data()[i]; }
  const T& operator[](size_t i) const { return data()[i]; }

 private:
  alignas(T) std::byte memory_[n * sizeof(T)];
};

}  // namespace alhazen
