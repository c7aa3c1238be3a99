#include "inspect/ray_tree.h"

#include <algorithm>

namespace alhazen {
namespace {

template <class F>
void for_each_addend(const TreeRay& ray, const F& f) {
  for (const TermAddend& term : ray.terms) f(term.addend);
  for (const TreeLight& light : ray.lights) f(light.addend);
}

}  // namespace

Rgb own_light(const TreeRay& ray) noexcept {
  Rgb sum;
  for_each_addend(ray, [&](const Addend& addend) { sum += addend.light; });
  return sum;
}

std::vector<Rgb> branch_light(const RayTree& tree) {
  std::vector<Rgb> sums;
  for (const TreeRay& ray : tree.rays) sums.push_back(own_light(ray));
  for (size_t i = tree.rays.size(); i-- > 1;) sums[tree.rays[i].parent] += sums[i];
  return sums;
}

std::vector<std::vector<uint32_t>> children(const RayTree& tree) {
  std::vector<std::vector<uint32_t>> lists(tree.rays.size());
  for (uint32_t i = 1; i < tree.rays.size(); ++i) lists[tree.rays[i].parent].push_back(i);
  return lists;
}

Rgb sum_in_order(const RayTree& tree) {
  std::vector<Addend> addends;
  for (const TreeRay& ray : tree.rays) for_each_addend(ray, [&](const Addend& addend) { addends.push_back(addend); });
  std::ranges::sort(addends, {}, &Addend::order);
  Rgb sum;
  for (const Addend& addend : addends) sum += addend.light;
  return sum;
}

}  // namespace alhazen
