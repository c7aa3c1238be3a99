#include "accel/shapes/composite.h"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace alhazen {
namespace {

using Operation = CompositeNode::Operation;

/// Puts the tree of `part` into `whole` as node `at`, each leaf moved by `map` and turned if `reversed`.
void graft(Composite& whole, uint32_t at, const Composite& part, uint32_t part_node, const Affine3d& map,
           bool reversed) {
  const CompositeNode node = part.nodes[part_node];
  if (node.operation == Operation::leaf) {
    CompositeLeaf leaf = part.leaves[node.first];
    leaf.chain.insert(leaf.chain.begin(), map);
    leaf.reversed = leaf.reversed != reversed;
    whole.nodes[at] = {Operation::leaf, uint32_t(whole.leaves.size()), 0};
    whole.leaves.push_back(std::move(leaf));
    return;
  }
  const auto first = uint32_t(whole.nodes.size());
  whole.nodes[at] = {node.operation, first, node.count};
  whole.nodes.resize(first + node.count);
  for (uint32_t k = 0; k < node.count; ++k) graft(whole, first + k, part, node.first + k, map, reversed);
}

Composite as_composite(const CompositeOperand& operand) {
  if (const auto* composite = std::get_if<Composite>(&operand.shape)) return *composite;
  Composite single;
  single.nodes.push_back({Operation::leaf, 0, 0});
  single.leaves.push_back({std::get<ClosedBody>(operand.shape), {}, {}, false});
  return single;
}

/// The numbers that make a leaf's surface, as bytes.
std::string surface_key(const CompositeLeaf& leaf) {
  std::string key(1, char(leaf.body.index()));
  const auto add = [&](double x) { key.append(reinterpret_cast<const char*>(&x), sizeof x); };
  const auto add_vector = [&](const Vec3d& v) { add(v.x), add(v.y), add(v.z); };
  struct Body {
    const decltype(add)& number;
    const decltype(add_vector)& vector;
    void operator()(const Sphere& s) const { number(s.radius); }
    void operator()(const Box& b) const { vector(b.size); }
    void operator()(const Cylinder& c) const { number(c.height), number(c.radius_bottom), number(c.radius_top); }
    void operator()(const Quadric& q) const {
      for (const double c : q.coefficients) number(c);
      vector(q.box.lower), vector(q.box.upper), number(q.whole);
    }
  };
  std::visit(Body{add, add_vector}, leaf.body);
  for (const Affine3d& m : leaf.chain) add_vector(m.x), add_vector(m.y), add_vector(m.z), add_vector(m.origin);
  return key;
}

/// A body that stands in one place more than once is crossed once: no arithmetic has to find out that it is met at the
/// same time as itself.
void find_twins(std::vector<CompositeLeaf>& leaves) {
  std::unordered_map<std::string, uint32_t> first;
  for (uint32_t k = 0; k < leaves.size(); ++k) {
    const auto [at, is_new] = first.emplace(surface_key(leaves[k]), k);
    leaves[k].twin = is_new ? CompositeLeaf::kNoTwin : at->second;
  }
}

/// Whether a point is inside, from whether it is inside of each leaf.
template <class InsideLeaf>
bool is_inside(const Composite& composite, const InsideLeaf& inside_leaf, uint32_t at = 0) {
  const CompositeNode& node = composite.nodes[at];
  if (node.operation == Operation::leaf) return inside_leaf(node.first);
  for (uint32_t k = 0; k < node.count; ++k) {
    const bool inside = is_inside(composite, inside_leaf, node.first + k);
    switch (node.operation) {
      case Operation::unite:
        if (inside) return true;
        break;
      case Operation::intersect:
        if (!inside) return false;
        break;
      default:
        if (inside != (k == 0)) return false;
    }
  }
  return node.operation != Operation::unite;
}

LineMap<double> leaf_map(const CompositeLeaf& leaf, double) { return leaf.body_from_composite; }
LineMap<Quad> leaf_map(const CompositeLeaf& leaf, Quad) { return quad_line_map(leaf.chain); }

/// Crossings of all leaves, before the tree has its say.
template <class T>
bool append_leaf_crossings(const Composite& composite, const ObjectLine<T>& line,
                           std::vector<CompositeCrossing<T>>& out) {
  for (size_t k = 0; k < composite.leaves.size(); ++k) {
    const CompositeLeaf& leaf = composite.leaves[k];
    if (leaf.twin != CompositeLeaf::kNoTwin) continue;
    const ObjectLine<T> leaf_line = object_line(leaf_map(leaf, T()), line);
    const auto found = std::visit([&](const auto& body) { return crossings(body, leaf_line); }, leaf.body);
    if (found.doubtful) return false;
    for (const auto& c : found.at)
      if (c.present) out.push_back({c.t, c.error, int(k) * kFacesPerLeaf + int(c.face)});
  }
  return true;
}

/// Leaves inside of which the line is, while it is followed.
class InsideLeaves {
 public:
  explicit InsideLeaves(const std::vector<CompositeLeaf>& leaves) : leaves_(leaves), count_((leaves.size() + 63) / 64) {
    if (count_ > inline_.size()) more_.assign(count_, 0);
  }
  /// A leaf that has no twin, and so all whose twin it is.
  void toggle(size_t leaf) {
    uint64_t* words = count_ > inline_.size() ? more_.data() : inline_.data();
    words[leaf / 64] ^= uint64_t(1) << (leaf % 64);
  }
  bool operator()(size_t leaf) const {
    const uint32_t twin = leaves_[leaf].twin;
    if (twin != CompositeLeaf::kNoTwin) leaf = twin;
    return words()[leaf / 64] >> (leaf % 64) & 1;
  }

 private:
  [[nodiscard]] const uint64_t* words() const { return count_ > inline_.size() ? more_.data() : inline_.data(); }

  const std::vector<CompositeLeaf>& leaves_;
  size_t count_;
  std::array<uint64_t, 4> inline_{};
  std::vector<uint64_t> more_;
};

Affine3d product(std::span<const Affine3d> chain) {
  Affine3d m = chain.front();
  for (const Affine3d& inner : chain.subspan(1)) m = m * inner;
  return m;
}

Bounds3d bounds_of(const Composite& composite, uint32_t at) {
  const CompositeNode& node = composite.nodes[at];
  if (node.operation == Operation::leaf) {
    const CompositeLeaf& leaf = composite.leaves[node.first];
    return transform_bounds(product(leaf.chain), std::visit([](const auto& b) { return bounds(b); }, leaf.body));
  }
  Bounds3d all = bounds_of(composite, node.first);
  if (node.operation == Operation::subtract) return all;
  for (uint32_t k = 1; k < node.count; ++k) {
    const Bounds3d one = bounds_of(composite, node.first + k);
    if (node.operation == Operation::unite)
      extend(all, one);
    else
      all = {max(all.lower, one.lower), min(all.upper, one.upper)};
  }
  return all;
}

/// Calls f(body, p_body, face of the body) for the leaf that a face belongs to.
template <class F>
auto at_leaf(const Composite& composite, const Vec3d& p_object, int face, const F& f) {
  const CompositeLeaf& leaf = composite.leaves[size_t(face / kFacesPerLeaf)];
  const Vec3d p_body = map_point(leaf.body_from_composite, p_object);
  return std::visit([&](const auto& body) { return f(leaf, body, p_body, face % kFacesPerLeaf); }, leaf.body);
}

}  // namespace

Composite make_composite(Operation operation, std::span<const CompositeOperand> operands) {
  Composite whole;
  whole.nodes.resize(1 + operands.size());
  whole.nodes[0] = {operation, 1, uint32_t(operands.size())};
  for (uint32_t k = 0; k < operands.size(); ++k)
    graft(whole, 1 + k, as_composite(operands[k]), 0, operands[k].composite_from_operand,
          operation == Operation::subtract && k > 0);
  find_twins(whole.leaves);
  for (CompositeLeaf& leaf : whole.leaves)
    leaf.body_from_composite =
        leaf.twin == CompositeLeaf::kNoTwin ? line_map(leaf.chain) : whole.leaves[leaf.twin].body_from_composite;
  return whole;
}

template <class T>
bool append_crossings(const Composite& composite, const ObjectLine<T>& line, std::vector<CompositeCrossing<T>>& out) {
  const size_t first = out.size();
  if (!append_leaf_crossings(composite, line, out)) return false;
  const auto begin = out.begin() + std::ptrdiff_t(first);
  std::sort(begin, out.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  InsideLeaves inside_leaf(composite.leaves);
  bool inside = false;
  size_t kept = first;
  T reached{};  // the largest upper bound so far
  for (size_t k = first; k < out.size(); ++k) {
    const CompositeCrossing<T> c = out[k];
    if (k > first && !(c.t - c.error > reached)) return false;  // which comes first?
    reached = k > first ? larger(reached, c.t + c.error) : c.t + c.error;
    inside_leaf.toggle(size_t(c.face / kFacesPerLeaf));
    const bool now = is_inside(composite, inside_leaf);
    if (now != inside) out[kept++] = c;
    inside = now;
  }
  out.resize(kept);
  return true;
}
template bool append_crossings(const Composite&, const ObjectLine<double>&, std::vector<CompositeCrossing<double>>&);
template bool append_crossings(const Composite&, const ObjectLine<Quad>&, std::vector<CompositeCrossing<Quad>>&);

std::vector<ExactCrossing> exact_crossings(const Composite& composite, const ExactLine& line) {
  std::vector<ExactCrossing> all, out;
  for (size_t k = 0; k < composite.leaves.size(); ++k) {
    const CompositeLeaf& leaf = composite.leaves[k];
    if (leaf.twin != CompositeLeaf::kNoTwin) continue;
    const ExactLine leaf_line = exact_line(leaf.chain, line);
    for (ExactCrossing& c : std::visit([&](const auto& b) { return exact_crossings(b, leaf_line); }, leaf.body))
      all.push_back({std::move(c.t), int(k) * kFacesPerLeaf + c.face});
  }
  // Stable, so that of surfaces met at once the first leaf's comes first.
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return compare(a.t, b.t) < 0; });
  InsideLeaves inside_leaf(composite.leaves);
  bool inside = false;
  for (size_t k = 0; k < all.size();) {
    const size_t first = k;
    for (; k < all.size() && (k == first || compare(all[k].t, all[first].t) == 0); ++k)
      inside_leaf.toggle(size_t(all[k].face / kFacesPerLeaf));
    const bool now = is_inside(composite, inside_leaf);
    if (now != inside) out.push_back(all[first]);
    inside = now;
  }
  return out;
}

Bounds3d bounds(const Composite& composite) noexcept { return bounds_of(composite, 0); }

Vec3d project(const Composite& composite, const Vec3d& p_object, int face) noexcept {
  return at_leaf(composite, p_object, face, [](const auto& leaf, const auto& body, const Vec3d& p, int f) {
    Vec3d outer = project(body, p, f);
    for (size_t k = leaf.chain.size(); k-- > 0;) outer = transform_point(leaf.chain[k], outer);
    return outer;
  });
}

Vec3d normal(const Composite& composite, const Vec3d& p_object, int face) noexcept {
  return at_leaf(composite, p_object, face, [](const auto& leaf, const auto& body, const Vec3d& p, int f) {
    const Vec3d n = normalize(outer_normal(leaf.body_from_composite, normal(body, p, f)));
    return leaf.reversed ? -n : n;
  });
}

Vec2f texture_coordinates(const Composite& composite, const Vec3d& p_object, int face) noexcept {
  return at_leaf(composite, p_object, face,
                 [](const auto&, const auto& body, const Vec3d& p, int f) { return texture_coordinates(body, p, f); });
}

Vec3d u_tangent(const Composite& composite, const Vec3d& p_object, int face) noexcept {
  return at_leaf(composite, p_object, face, [](const auto& leaf, const auto& body, const Vec3d& p, int f) {
    Vec3d t = u_tangent(body, p, f);
    for (size_t k = leaf.chain.size(); k-- > 0;) t = transform_vector(leaf.chain[k], t);
    return t;
  });
}

}  // namespace alhazen
