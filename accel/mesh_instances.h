// Where meshes are placed: one by one, or as arrays of many below one node.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "core/transform.h"

namespace alhazen {

struct MeshInstance {
  uint32_t mesh = 0;
  uint32_t node = 0;  // glTF node index
  Affine3d world_from_object;
};

/// One mesh at `count` places below a node, by the numbers that a file gives for each: 12 to 40 bytes, where a map
/// takes 96. `translations`, `rotations` (quaternions x, y, z, w of any length; 0 turns nothing) and `scales` are empty
/// or have an element for each place.
struct InstanceArray {
  uint32_t mesh = 0, node = 0;
  Affine3d world_from_node;
  uint32_t count = 0;
  std::vector<Vec3f> translations{};
  std::vector<Vec4f> rotations{};
  std::vector<Vec3f> scales{};
};

/// The node's map after translation x rotation x scale, which is rounded to float.
[[nodiscard]] Affine3d world_from_object(const InstanceArray& array, size_t k);

/// A list of instances, numbered in the order in which they come, that gives each by value.
class MeshInstances {
 public:
  MeshInstances() = default;
  MeshInstances(std::initializer_list<MeshInstance> alone) : alone_(alone) {}

  void push_back(const MeshInstance& instance) { alone_.push_back(instance); }
  /// Its places one after the other; a few become instances of their own.
  void append(InstanceArray array);
  /// Moves one that is not of an array.
  void place(size_t i, const Affine3d& world_from_object) { alone_[find(i).k].world_from_object = world_from_object; }

  [[nodiscard]] size_t size() const { return alone_.size() + in_arrays_; }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] uint32_t mesh_of(size_t i) const {
    const Found at = find(i);
    return at.array ? at.array->mesh : alone_[at.k].mesh;
  }
  [[nodiscard]] uint32_t node_of(size_t i) const {
    const Found at = find(i);
    return at.array ? at.array->node : alone_[at.k].node;
  }
  [[nodiscard]] Affine3d world_from_object(size_t i) const {
    const Found at = find(i);
    return at.array ? alhazen::world_from_object(*at.array, at.k) : alone_[at.k].world_from_object;
  }
  [[nodiscard]] MeshInstance operator[](size_t i) const { return {mesh_of(i), node_of(i), world_from_object(i)}; }

  class Iterator {
   public:
    Iterator(const MeshInstances& all, size_t i) : all_(&all), i_(i) {}
    MeshInstance operator*() const { return (*all_)[i_]; }
    Iterator& operator++() { return ++i_, *this; }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }

   private:
    const MeshInstances* all_;
    size_t i_;
  };
  [[nodiscard]] Iterator begin() const { return {*this, 0}; }
  [[nodiscard]] Iterator end() const { return {*this, size()}; }

 private:
  struct NumberedArray {
    size_t first, alone_before;
    InstanceArray array;
  };
  struct Found {
    const InstanceArray* array;  // null: one of alone_
    size_t k;
  };
  [[nodiscard]] Found find(size_t i) const {
    const auto after = std::upper_bound(arrays_.begin(), arrays_.end(), i,
                                        [](size_t number, const NumberedArray& a) { return number < a.first; });
    if (after == arrays_.begin()) return {nullptr, i};
    const NumberedArray& before = *(after - 1);
    const size_t k = i - before.first;
    if (k < before.array.count) return {&before.array, k};
    return {nullptr, before.alone_before + (k - before.array.count)};
  }

  std::vector<MeshInstance> alone_;
  std::vector<NumberedArray> arrays_;
  size_t in_arrays_ = 0;
};

}  // namespace alhazen
