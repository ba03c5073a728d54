#include "mien/sample/detail/half_head.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mien/core/parallel.h"
#include "mien/sample/detail/smooth_step.h"

namespace mien::sample {

int HalfHead::add(const Vector3d& point, const Vector2d& uv, Hold hold, bool on_midline) {
  points.push_back(point);
  uvs.push_back(uv);
  holds.push_back(hold);
  midline.push_back(on_midline);
  if (on_midline) points.back().x() = 0;
  return static_cast<int>(points.size()) - 1;
}

void HalfHead::bridge(const Loop& outer, const Loop& inner, bool closed) {
  const std::size_t n = outer.size(), cells = closed ? n : n - 1;
  for (std::size_t a = 0; a < cells; ++a) {
    const std::size_t b = (a + 1) % n;
    quads.push_back({outer[a], inner[a], inner[b], outer[b]});
    cap.push_back(0);
  }
}

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The rays of one row of the grid, and the azimuths of all columns.
struct Rays {
  std::vector<KeyRow> rows;
  std::vector<double> azimuths;
};

Rays make_rays(const GridForm& grid) {
  Rays rays;
  rays.rows.push_back(grid.rows[0]);
  for (std::size_t k = 1; k < grid.rows.size(); ++k) {
    const KeyRow &a = grid.rows[k - 1], &b = grid.rows[k];
    for (int s = 1; s <= b.steps; ++s) {
      const double t = double(s) / b.steps;
      const auto mix = [t](double x, double y) { return x + t * (y - x); };
      rays.rows.push_back({1, mix(a.axis_y, b.axis_y), mix(a.axis_z, b.axis_z), mix(a.front, b.front),
                           mix(a.side, b.side), mix(a.back, b.back)});
    }
  }
  rays.azimuths.push_back(grid.columns[0].azimuth);
  for (std::size_t k = 1; k < grid.columns.size(); ++k)
    for (int s = 1; s <= grid.columns[k].steps; ++s)
      rays.azimuths.push_back(grid.columns[k - 1].azimuth +
                              s * (grid.columns[k].azimuth - grid.columns[k - 1].azimuth) /
                                  grid.columns[k].steps);
  return rays;
}

Vector3d ray_direction(const KeyRow& row, double azimuth) {
  const double to_side = smooth_step(15, 100, azimuth), to_back = smooth_step(100, 170, azimuth);
  const double elevation =
      kDegree * (row.front + to_side * (row.side - row.front) + to_back * (row.back - row.side));
  const double a = azimuth * kDegree;
  return {std::sin(a) * std::cos(elevation), std::sin(elevation), std::cos(a) * std::cos(elevation)};
}

bool inside(const Block& block, int i, int j) {
  return i >= block.i0 && i < block.i1 && j >= block.j0 && j < block.j1;
}
/// Strictly inside; a block that starts on the midline has no inner border there.
bool vertex_inside(const Block& block, int i, int j) {
  return (i > block.i0 || (block.i0 == 0 && i == 0)) && i < block.i1 && j > block.j0 && j < block.j1;
}

/// The crown: a rectangle of cells across the top, its border the grid's last row.
void add_crown(HalfHead& half, const HeadForm& form) {
  const int columns = static_cast<int>(half.grid.size()) - 1, top = static_cast<int>(half.grid[0].size()) - 1;
  const int width = form.grid.crown_width, length = columns - 2 * width;
  // cell corner (x, y): x cells from the middle, y cells from the front.
  std::vector<std::vector<int>> ids(width + 1, std::vector<int>(length + 1, -1));
  const auto border = [&](int i) { return half.grid[i][top]; };
  for (int x = 0; x <= width; ++x) {
    ids[x][0] = border(x);
    ids[x][length] = border(columns - x);
  }
  for (int y = 0; y <= length; ++y) ids[width][y] = border(width + y);
  for (int x = 0; x < width; ++x)
    for (int y = 1; y < length; ++y) {
      const double s = double(x) / width, t = double(y) / length;
      const Vector3d across =
          (1 - s) * Vector3d(0, half.points[ids[width][y]].y(), half.points[ids[width][y]].z()) +
          s * half.points[ids[width][y]];
      const Vector3d along = (1 - t) * half.points[ids[x][0]] + t * half.points[ids[x][length]];
      Vector3d p = (across + along) / 2 + Vector3d(0, 4, 0);
      p.y() += 3 * (1 - s * s) * 4 * t * (1 - t);
      ids[x][y] = half.add(form.sculpt.project(p, 12), {0, 0}, HalfHead::Hold::free, x == 0);
    }
  for (int x = 0; x < width; ++x)
    for (int y = 0; y < length; ++y) {
      half.quads.push_back({ids[x][y], ids[x + 1][y], ids[x + 1][y + 1], ids[x][y + 1]});
      half.cap.push_back(1);
    }
}

}  // namespace

HalfHead make_grid(const HeadForm& form) {
  HalfHead half;
  const Rays rays = make_rays(form.grid);
  const int columns = static_cast<int>(rays.azimuths.size()) - 1,
            rows = static_cast<int>(rays.rows.size()) - 1;
  const std::array<Block, 4> blocks = {form.grid.eye, form.grid.mouth, form.grid.nostril, form.grid.ear};
  half.grid.assign(columns + 1, std::vector<int>(rows + 1, -1));
  for (int i = 0; i <= columns; ++i)
    for (int j = 0; j <= rows; ++j) {
      if (std::any_of(blocks.begin(), blocks.end(), [&](const Block& b) { return vertex_inside(b, i, j); }))
        continue;
      const KeyRow& row = rays.rows[j];
      const Vector3d at = form.sculpt.cast({0, row.axis_y, row.axis_z}, ray_direction(row, rays.azimuths[i]));
      const bool on_midline = i == 0 || i == columns;
      // UVs give the narrow columns of the face more room than their angle.
      const double around = 0.45 * rays.azimuths[i] / 180 + 0.55 * i / columns;
      half.grid[i][j] = half.add(at, {0.5 + 0.5 * around, 0.8 * j / rows},
                                 j == 0 ? HalfHead::Hold::fixed : HalfHead::Hold::free, on_midline);
    }
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      if (std::any_of(blocks.begin(), blocks.end(), [&](const Block& b) { return inside(b, i, j); }))
        continue;
      half.quads.push_back(
          {half.grid[i][j], half.grid[i + 1][j], half.grid[i + 1][j + 1], half.grid[i][j + 1]});
      half.cap.push_back(0);
    }
  add_crown(half, form);
  return half;
}

Loop border_of(const HalfHead& half, const Block& block) {
  Loop loop;
  const int middle = (block.j0 + block.j1) / 2;
  const bool open = block.i0 == 0;
  if (!open)
    for (int j = middle; j < block.j1; ++j) loop.push_back(half.grid[block.i0][j]);
  for (int i = block.i0; i < block.i1; ++i) loop.push_back(half.grid[i][block.j1]);
  for (int j = block.j1; j > block.j0; --j) loop.push_back(half.grid[block.i1][j]);
  for (int i = block.i1; i > block.i0; --i) loop.push_back(half.grid[i][block.j0]);
  if (open)
    loop.push_back(half.grid[0][block.j0]);
  else
    for (int j = block.j0; j < middle; ++j) loop.push_back(half.grid[block.i0][j]);
  return loop;
}

void relax(HalfHead& half, const HeadForm& form) {
  // The last rounds even out what cells too large for the flesh's creases leave: they leave the flesh a little.
  constexpr int kPolish = 2;
  const std::size_t n = half.points.size();
  std::vector<std::vector<int>> around(n);
  for (const auto& quad : half.quads) {
    const int corners = quad[3] < 0 ? 3 : 4;
    for (int c = 0; c < corners; ++c) {
      around[quad[c]].push_back(quad[(c + 1) % corners]);
      around[quad[(c + 1) % corners]].push_back(quad[c]);
    }
  }
  for (auto& list : around) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  for (std::size_t v = 0; v < n; ++v)
    if (half.holds[v] != HalfHead::Hold::fixed) {
      half.points[v] = form.sculpt.project(half.points[v], 8);
      if (half.midline[v]) half.points[v].x() = 0;
    }
  std::vector<Vector3d> next = half.points;
  for (int round = 0; round < form.grid.relaxations; ++round) {
    parallel_for(n, 128, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (half.holds[v] != HalfHead::Hold::free) continue;
        Vector3d sum = Vector3d::Zero();
        double weight = 0;
        for (int other : around[v]) {
          // On the midline a neighbour to the left stands for its mirror image as well.
          const double w = half.midline[v] && !half.midline[other] ? 2 : 1;
          sum += w * half.points[other];
          weight += w;
        }
        Vector3d p = half.points[v], normal = form.sculpt.normal(p);
        Vector3d move = sum / weight - p;
        if (half.midline[v]) move.x() = normal.x() = 0;
        if (round + kPolish < form.grid.relaxations) {
          p += 0.6 * (move - normal * normal.dot(move));
          p -= form.sculpt.distance(p) * normal;
        } else {
          p += 0.5 * move;
        }
        if (half.midline[v]) p.x() = 0;
        next[v] = p;
      }
    });
    half.points.swap(next);
  }
}

}  // namespace mien::sample
