#include "awmr/simulate/passage.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace awmr {
namespace {

/// A disc that contains the start or target point is shrunk to this fraction of the distance from
/// its centre to the point, so that the point is outside.
constexpr double kShrunk = 1.0 - 1e-9;

/// Twice the signed area of the triangle a, b, c: >= 0 if c is on the line from a to b or to its
/// left.
double turn(const Position<double>& a, const Position<double>& b, const Position<double>& c) {
  return (b.x_m - a.x_m) * (c.y_m - a.y_m) - (b.y_m - a.y_m) * (c.x_m - a.x_m);
}

/// True if the segments a-b and c-d cross. A point on a line counts as left of it, so a chain of
/// segments with a vertex on a-b crosses a-b once and not twice.
bool cross(const Position<double>& a, const Position<double>& b, const Position<double>& c,
           const Position<double>& d) {
  const auto left = [](double area) { return area >= 0.0; };
  return left(turn(a, b, c)) != left(turn(a, b, d)) && left(turn(c, d, a)) != left(turn(c, d, b));
}

/// Groups of overlapping discs (union-find with parities). An edge joins the centres of two
/// overlapping discs; it is odd if it crosses the segment from `from` to `to`. The parity of a disc
/// is that of the number of odd edges on the path from it to the root of its group.
class ParitySets {
 public:
  explicit ParitySets(std::size_t count) : parent_(count), odd_(count, false) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  /// Joins the groups of the discs a and b by an edge. Returns false if the edge closes a cycle
  /// with an odd number of odd edges, which encircles one of the two points.
  bool join(std::size_t a, std::size_t b, bool odd) {
    const auto [root_a, odd_a] = root(a);
    const auto [root_b, odd_b] = root(b);
    if (root_a == root_b) return (odd_a != odd_b) == odd;
    parent_[root_a] = root_b;
    odd_[root_a] = (odd_a != odd_b) != odd;
    return true;
  }

 private:
  std::pair<std::size_t, bool> root(std::size_t i) const {
    bool odd = false;
    while (parent_[i] != i) {
      odd = odd != odd_[i];
      i = parent_[i];
    }
    return {i, odd};
  }
  std::vector<std::size_t> parent_;
  std::vector<bool> odd_;
};

}  // namespace

bool passage_exists(const std::vector<Obstacle<double>>& obstacles, double grow_m,
                    const Position<double>& from, const Position<double>& to) {
  std::vector<double> radii;
  for (const Obstacle<double>& obstacle : obstacles) {
    const double near =
        std::min(distance_m(obstacle.centre_m, from), distance_m(obstacle.centre_m, to));
    radii.push_back(std::min(obstacle.radius_m + grow_m, kShrunk * near));
  }
  ParitySets sets(obstacles.size());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    for (std::size_t j = i + 1; j < obstacles.size(); ++j) {
      const Position<double>& a = obstacles[i].centre_m;
      const Position<double>& b = obstacles[j].centre_m;
      if (!(distance_m(a, b) < radii[i] + radii[j])) continue;
      if (!sets.join(i, j, cross(from, to, a, b))) return false;
    }
  }
  return true;
}

}  // namespace awmr
