// The 68 iBUG points: 1-17 jaw from the right ear over the chin to the left ear, 18-27 brows, 28-36 nose,
// 37-48 eyes, 49-68 mouth. "Right" is the character's, at -X.

#include <algorithm>
#include <cmath>

#include "mien/sample/detail/character_form.h"

namespace mien::sample {

namespace {

class LandmarkWriter {
 public:
  LandmarkWriter(Character& character, const HeadMesh& head) : character_(character), head_(head) {
    // The inside of openings takes no landmark.
    outer_.assign(head.half.points.size(), 1);
    const auto hide = [&](const std::vector<Loop>& loops, std::size_t from) {
      for (std::size_t k = from; k < loops.size(); ++k)
        for (int v : loops[k]) outer_[v] = 0;
    };
    hide(head.half.eye, head.half.lid_edge);
    hide(head.half.mouth, head.half.lip_contact);
    hide(head.half.nostril, 2);
    hide(head.half.ear, 1);
  }

  /// The closest vertex outside that is no landmark yet.
  int closest(const Vector3d& p) const {
    int best = -1;
    double least = 1e300;
    for (std::size_t v = 0; v < outer_.size(); ++v) {
      const double d = (head_.half.points[v] - p).squaredNorm();
      if (outer_[v] && d < least) {
        least = d;
        best = static_cast<int>(v);
      }
    }
    return best;
  }
  int twin(int vertex) const { return head_.mirror[vertex]; }
  void put(int number, int vertex) {
    for (int v : {vertex, twin(vertex)})
      if (v < static_cast<int>(outer_.size())) outer_[v] = 0;
    Landmark landmark;
    landmark.name = "ibug_" + std::to_string(number);
    landmark.at = at(vertex);
    character_.landmarks.push_back(landmark);
  }
  void put_curve(const std::string& name, const std::vector<int>& vertices, int count) {
    LandmarkCurve curve;
    curve.name = name;
    for (int v : vertices) curve.points.push_back(at(v));
    curve.count = count;
    character_.curves.push_back(curve);
  }

 private:
  static SurfacePoint at(int vertex) {
    SurfacePoint point;
    point.part = face_part;
    point.vertex = vertex;
    return point;
  }
  Character& character_;
  const HeadMesh& head_;
  std::vector<char> outer_;
};

/// Six points around the left eye: inner corner, two above, outer corner, two below (from outer to inner).
std::vector<int> eye_points(const HeadMesh& head) {
  const Loop& edge = head.half.eye[head.half.lid_edge];
  const int count = static_cast<int>(edge.size()), turn = count / 2;
  const int third = static_cast<int>(std::lround(turn * 0.39));
  return {edge[0], edge[third], edge[turn - third], edge[turn], edge[turn + third], edge[count - third]};
}

}  // namespace

void add_landmarks(Character& character, const HeadMesh& head, const CharacterForm& form) {
  LandmarkWriter out(character, head);
  const LandmarkForm& given = form.landmarks;
  const auto closest = [&](const std::vector<Vector3d>& list) {
    std::vector<int> vertices;
    for (const Vector3d& p : list) vertices.push_back(out.closest(p));
    return vertices;
  };
  const std::vector<int> jaw = closest(given.jaw), brow = closest(given.brow), nose = closest(given.nose),
                         base = closest(given.base);
  for (int i = 1; i <= 8; ++i) out.put(i, out.twin(jaw[9 - i]));
  for (int i = 9; i <= 17; ++i) out.put(i, jaw[i - 9]);
  for (int i = 0; i < 5; ++i) out.put(18 + i, out.twin(brow[4 - i]));
  for (int i = 0; i < 5; ++i) out.put(23 + i, brow[i]);
  for (int i = 0; i < 4; ++i) out.put(28 + i, nose[i]);
  for (int i = 0; i < 2; ++i) out.put(32 + i, out.twin(base[2 - i]));
  for (int i = 0; i < 3; ++i) out.put(34 + i, base[i]);

  const std::vector<int> eye = eye_points(head);
  const int right_order[6] = {3, 2, 1, 0, 5, 4};
  for (int i = 0; i < 6; ++i) out.put(37 + i, out.twin(eye[right_order[i]]));
  for (int i = 0; i < 6; ++i) out.put(43 + i, eye[i]);

  const Loop &border = head.half.mouth[head.half.lip_border],
             &contact = head.half.mouth[head.half.lip_contact];
  const int last = static_cast<int>(border.size()) - 1, turn = last / 2;
  // The bow's peak, and a point on the way to the corner, by the slots of the loop.
  const int peak = std::max(1, static_cast<int>(std::lround(turn * 0.16))),
            way = static_cast<int>(std::lround(turn * 0.5));
  const int outer_upper[4] = {turn, way, peak, 0};
  for (int i = 0; i < 3; ++i) out.put(49 + i, out.twin(border[outer_upper[i]]));
  for (int i = 0; i < 4; ++i) out.put(52 + i, border[outer_upper[3 - i]]);
  const int low_near = static_cast<int>(std::lround(turn * 0.25)),
            low_far = static_cast<int>(std::lround(turn * 0.55));
  out.put(56, border[last - low_far]);
  out.put(57, border[last - low_near]);
  out.put(58, border[last]);
  out.put(59, out.twin(border[last - low_near]));
  out.put(60, out.twin(border[last - low_far]));
  const int inner = static_cast<int>(std::lround(turn * 0.25));
  out.put(61, out.twin(contact[turn]));
  out.put(62, out.twin(contact[inner]));
  out.put(63, contact[0]);
  out.put(64, contact[inner]);
  out.put(65, contact[turn]);
  out.put(66, contact[last - inner]);
  out.put(67, contact[last]);
  out.put(68, out.twin(contact[last - inner]));

  // Curves run beside the points, so that no sample falls on one of them.
  std::vector<int> above, mirrored_above;
  for (const Vector3d& p : given.brow) {
    const int v = out.closest(p + Vector3d(0.25, 0.06 * (given.jaw[8].y() - given.jaw[0].y()), 0));
    if (!above.empty() && above.back() == v) continue;
    above.push_back(v);
    mirrored_above.push_back(out.twin(v));
  }
  out.put_curve("browLeft", above, 4);
  out.put_curve("browRight", mirrored_above, 4);
  const Loop& lip = head.half.mouth[head.half.lip_border + 1];
  std::vector<int> upper, lower;
  for (int a = turn - 2; a > 0; --a) {
    upper.push_back(out.twin(lip[a]));
    lower.push_back(out.twin(lip[last - a]));
  }
  for (int a = 0; a <= turn - 2; ++a) {
    upper.push_back(lip[a]);
    lower.push_back(lip[last - a]);
  }
  out.put_curve("lipUpper", upper, 7);
  out.put_curve("lipLower", lower, 7);
}

}  // namespace mien::sample
