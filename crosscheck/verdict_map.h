// Where on their surfaces rays were judged, and who was right: what a map shows of a family.
#pragma once

#include <array>
#include <vector>

#include "crosscheck/crosscheck.h"

namespace alhazen::crosscheck {

/// What a map has a sheet for: the surface, by its texture coordinates, triangles by their barycentric weights; plane
/// faces and caps of bodies that have curved walls, too; spheres and cylinders as the ray sees them, along itself with
/// the axis upright, so that all silhouettes of a sphere are one circle.
enum class SheetKind : uint8_t { surface, flat_faces, outline };
inline constexpr int kSheetKinds = 3;
inline constexpr double kOutlineMargin = 1.25;  // an outline's sheet is by so much larger than the body

struct MapPlace {
  SheetKind sheet = SheetKind::surface;
  double u = 0, v = 0;  // in [0, 1]
};

/// Where the ray belongs. On the surface: where the judge says that it hits, and where it hits nothing, where a party
/// wrongly says so.
[[nodiscard]] std::vector<MapPlace> map_places(const Case& c);

/// What a map tells apart, the worst last: of Embree's errors those of t from wrong decisions.
enum class Mark : uint8_t { agree, tie, native_inexact, native_wrong, custom_wrong, both_wrong, unexplained };
inline constexpr int kMarks = 7;
[[nodiscard]] Mark mark_of(const Case& c);

/// A square of cells over (u, v); each counts its marks.
class VerdictSheet {
 public:
  explicit VerdictSheet(int side) : side_(side), cells_(size_t(side) * size_t(side)) {}

  void add(const MapPlace& place, Mark mark);

  struct Cell {
    std::array<uint32_t, kMarks> count{};
    [[nodiscard]] uint32_t of(Mark mark) const { return count[size_t(mark)]; }
    [[nodiscard]] uint32_t rays() const;
  };
  [[nodiscard]] int side() const { return side_; }
  [[nodiscard]] const Cell& at(int x, int y) const { return cells_[size_t(y) * size_t(side_) + size_t(x)]; }
  [[nodiscard]] bool is_empty() const { return rays_ == 0; }

 private:
  int side_;
  uint64_t rays_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace alhazen::crosscheck
