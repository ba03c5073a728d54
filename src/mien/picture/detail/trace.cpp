// Three passes over the pixels.
//   1. 16 primary rays a pixel; a shadow ray to a point of the key light and a ray to a point of the sky from
//   each hit.
//      All 16 go to Embree as one packet: three packets a pixel.
//   2. Key visibility and sky visibility are averaged over 4 x 4 pixels along the surface (depth and normal
//   agree). Each
//      of the 16 pixels of such a block has its own cell of the 256 strata, so that the average has 256 even
//      samples: smooth at a sixteenth of the rays, and, without any random number, the same at any thread
//      count.
//   3. Colour: base x (key + fill + sky), light bounced in cavities by the base colour, then the display's
//   curve.
// Shadow and sky rays start from the smooth surface that the normals promise, not from the flat triangle:
// without that, coarse meshes show their triangles along the terminator (Hanika 2021, Hacking the Shadow
// Terminator).
#include "mien/picture/detail/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "mien/core/parallel.h"

namespace mien::detail {
namespace {

using Vec = Eigen::Vector3f;

constexpr int samples = 16;
constexpr float key_radius = 0.16f;  // of the light's disc at distance one: penumbrae as of a softbox
constexpr float offset = 2e-5f;      // rays start this far off the surface; scene units
const Vec key_color(1.08f, 1.02f, 0.94f), sky_color(0.45f, 0.48f, 0.52f), fill_color(0.12f, 0.12f, 0.13f);

/// What a pixel gathers in the first pass.
struct Gathered {
  Vec key = Vec::Zero();   // light of the key if nothing were in its way
  Vec fill = Vec::Zero();  // light of the fill
  Vec base = Vec::Zero();  // base colour
  Vec normal = Vec::Zero(), position = Vec::Zero();
  float coverage = 0, key_visible = 0, sky_visible = 0;
};

struct Hit {
  Vec position, normal, base;  // shading normal, towards the eye
  Vec start;                   // where secondary rays leave from
  float gloss = 0, sharpness = 1;
};

struct Lights {
  Vec key, key_x, key_y, fill, up;
};

/// The lights stand around the camera: every view is lit alike.
Lights make_lights(const Lens& lens) {
  Lights lights;
  lights.key = (-0.48f * lens.right + 0.62f * lens.up + 0.62f * lens.back).normalized();
  lights.key_x = lights.key.cross(lens.up).normalized();
  lights.key_y = lights.key.cross(lights.key_x);
  lights.fill = (0.75f * lens.right + 0.05f * lens.up + 0.65f * lens.back).normalized();
  lights.up = lens.up;
  return lights;
}

/// Point `s` of the 16 strata of a pixel, in cell `cell` of 16 finer strata; [0, 1)^2.
Eigen::Vector2f stratum(int s, int cell) {
  return {(static_cast<float>(s % 4) + (static_cast<float>(cell % 4) + 0.5f) / 4) / 4,
          (static_cast<float>(s / 4) + (static_cast<float>(cell / 4) + 0.5f) / 4) / 4};
}

/// The cells of a 4 x 4 block of pixels, neighbours far apart.
int cell_of(int x, int y) {
  static constexpr std::array<int, 16> bayer{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  return bayer[(y & 3) * 4 + (x & 3)];
}

class Tracer {
 public:
  Tracer(const RayScene& scene, const Soup& soup, const Lens& lens, const TraceOptions& options)
      : scene_(scene),
        looks_(soup.looks),
        textures_(soup.paint.textures),
        lens_(lens),
        options_(options),
        lights_(make_lights(lens)) {}

  Gathered gather(int x, int y) const;

 private:
  void see_through(RTCRayHit16& rays, int cell) const;
  float opacity(const RTCRayHit16& rays, int s) const;
  Eigen::Vector4f texture_color(const Look& look, int triangle, const Vec& corners) const;
  bool surface(const RTCRayHit16& rays, int s, Hit& hit) const;
  Vec base_color(const Look& look, int triangle, const Vec& corners) const;
  bool on_edge(int triangle, const Vec& corners, float depth) const;
  void shade(const std::array<Hit, samples>& hits, const std::array<int, samples>& valid, int cell,
             Gathered& gathered) const;

  const RayScene& scene_;
  const std::vector<Look>& looks_;
  const std::vector<Texture>& textures_;
  const Lens& lens_;
  const TraceOptions& options_;
  Lights lights_;
};

Eigen::Vector4f Tracer::texture_color(const Look& look, int triangle, const Vec& corners) const {
  const CornerUvs& uv = scene_.uvs[triangle];
  return textures_[look.texture].linear(corners[0] * uv[0] + corners[1] * uv[1] + corners[2] * uv[2]);
}

Vec Tracer::base_color(const Look& look, int triangle, const Vec& corners) const {
  const Eigen::Vector3i& t = scene_.triangles[triangle];
  if (!scene_.mapped[triangle]) {
    Vec color = look.albedo;
    if (look.texture >= 0) color = color.cwiseProduct(texture_color(look, triangle, corners).head<3>());
    if (look.painted)
      color = color.cwiseProduct(corners[0] * scene_.colors[t[0]] + corners[1] * scene_.colors[t[1]] +
                                 corners[2] * scene_.colors[t[2]]);
    return color;
  }
  const float value =
      corners[0] * scene_.values[t[0]] + corners[1] * scene_.values[t[1]] + corners[2] * scene_.values[t[2]];
  const VertexMap& map = *options_.map;
  const double span = map.high - map.low;
  return linear_of(map_color(map.colors, span != 0 ? (value - map.low) / span : 0));
}

/// Whether the point is within half a pixel of a polygon's edge.
bool Tracer::on_edge(int triangle, const Vec& corners, float depth) const {
  const Eigen::Vector3i& t = scene_.triangles[triangle];
  const Vec &a = scene_.positions[t[0]], &b = scene_.positions[t[1]], &c = scene_.positions[t[2]];
  const float twice_area = (b - a).cross(c - a).norm();
  const std::array<float, 3> sides{(c - b).norm(), (a - c).norm(), (b - a).norm()};
  for (int k = 0; k < 3; ++k)
    if ((scene_.edges[triangle] >> k & 1) && corners[k] * twice_area < 0.55f * lens_.pixel(depth) * sides[k])
      return true;
  return false;
}

bool Tracer::surface(const RTCRayHit16& rays, int s, Hit& hit) const {
  if (rays.hit.geomID[s] == RTC_INVALID_GEOMETRY_ID) return false;
  const int triangle = scene_.triangle_of(rays.hit.geomID[s], rays.hit.primID[s]);
  const Vec corners(1 - rays.hit.u[s] - rays.hit.v[s], rays.hit.u[s], rays.hit.v[s]);
  const Vec to_eye = -Vec(rays.ray.dir_x[s], rays.ray.dir_y[s], rays.ray.dir_z[s]);
  const Vec flat(rays.hit.Ng_x[s], rays.hit.Ng_y[s], rays.hit.Ng_z[s]);
  const float side = flat.dot(to_eye) < 0 ? -1.f : 1.f;
  const Eigen::Vector3i& t = scene_.triangles[triangle];
  const Vec outside = side * flat.normalized();
  // Where a rim folds over (a closed lid's), a corner's normal may belong to the other side: it says nothing about this one.
  std::array<Vec, 3> normals;
  for (int k = 0; k < 3; ++k) {
    const Vec normal = side * scene_.normals[t[k]];
    normals[static_cast<std::size_t>(k)] = normal.dot(outside) > 0 ? normal : outside;
  }
  hit.position = hit.normal = Vec::Zero();
  for (int k = 0; k < 3; ++k) {
    hit.position += corners[k] * scene_.positions[t[k]];
    hit.normal += corners[k] * normals[static_cast<std::size_t>(k)];
  }
  hit.normal.normalize();
  // At silhouettes smooth normals may turn away from the eye: bend them back to grazing.
  const float facing = hit.normal.dot(to_eye);
  if (facing < 0.02f) hit.normal = (hit.normal + (0.02f - facing) * to_eye).normalized();
  Vec lifted = hit.position;
  for (int k = 0; k < 3; ++k) {
    const Vec& normal = normals[static_cast<std::size_t>(k)];
    lifted -= corners[k] * std::min(0.f, (hit.position - scene_.positions[t[k]]).dot(normal)) * normal;
  }
  hit.start = lifted + offset * outside;
  const Look& look = looks_[scene_.looks[triangle]];
  hit.base = base_color(look, triangle, corners);
  hit.gloss = scene_.mapped[triangle] ? 0 : look.gloss;
  hit.sharpness = look.sharpness;
  // The back of a closed skin is the inside of a head: seen only through a hole, it stays in the dark.
  if (side < 0 && !look.two_sided) hit.base *= 0.35f, hit.gloss = 0;
  if (options_.wireframe && on_edge(triangle, corners, lens_.project(hit.position).z()))
    hit.base *= 0.18f, hit.gloss = 0;
  return true;
}

void set_ray(RTCRay16& rays, int s, const Vec& from, const Vec& direction) {
  rays.org_x[s] = from.x();
  rays.org_y[s] = from.y();
  rays.org_z[s] = from.z();
  rays.dir_x[s] = direction.x();
  rays.dir_y[s] = direction.y();
  rays.dir_z[s] = direction.z();
  rays.tnear[s] = 0;
  rays.tfar[s] = std::numeric_limits<float>::infinity();
  rays.mask[s] = ~0u;
  rays.time[s] = 0;
  rays.id[s] = 0;
  rays.flags[s] = 0;
}

/// Cosine-weighted direction around `normal`.
Vec sky_direction(const Vec& normal, const Eigen::Vector2f& u) {
  const float angle = 2 * std::numbers::pi_v<float> * u.x(), r = std::sqrt(u.y());
  const float sign = std::copysign(1.f, normal.z()), a = -1 / (sign + normal.z()),
              b = normal.x() * normal.y() * a;
  const Vec x(1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x());
  const Vec y(b, sign + normal.y() * normal.y() * a, -normal.y());
  return r * std::cos(angle) * x + r * std::sin(angle) * y + std::sqrt(std::max(0.f, 1 - u.y())) * normal;
}

void Tracer::shade(const std::array<Hit, samples>& hits, const std::array<int, samples>& valid, int cell,
                   Gathered& gathered) const {
  alignas(64) RTCRay16 key, sky;
  std::array<float, samples> sky_light{};
  for (int s = 0; s < samples; ++s) {
    const Hit& hit = hits[s];
    const Eigen::Vector2f u = stratum((s * 5 + 3) % samples, cell),
                          w = stratum((s * 11 + 7) % samples, (cell * 7 + 5) % 16);
    const float r = key_radius * std::sqrt(u.x()), angle = 2 * std::numbers::pi_v<float> * u.y();
    const Vec to_key =
        lights_.key + r * std::cos(angle) * lights_.key_x + r * std::sin(angle) * lights_.key_y;
    const Vec to_sky = valid[s] ? sky_direction(hit.normal, w) : Vec(0, 0, 1);
    set_ray(key, s, valid[s] ? hit.start : Vec(0, 0, 0), to_key.normalized());
    set_ray(sky, s, valid[s] ? hit.start : Vec(0, 0, 0), to_sky);
    sky_light[s] = 0.68f + 0.32f * to_sky.dot(lights_.up);
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid.data(), scene_.solid(), &context, &sky);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid.data(), scene_.solid(), &context, &key);
  for (int s = 0; s < samples; ++s) {
    if (!valid[s]) continue;
    const Hit& hit = hits[s];
    const float cosine = std::max(0.f, hit.normal.dot(lights_.key));
    const Vec half = (lights_.key + (lens_.eye - hit.position).normalized()).normalized();
    const float shine =
        hit.gloss * std::pow(std::max(0.f, hit.normal.dot(half)), hit.sharpness) * (cosine > 0 ? 1.f : 0.f);
    gathered.key += key_color.cwiseProduct(hit.base * cosine + Vec::Constant(shine));
    gathered.fill += fill_color.cwiseProduct(hit.base) * std::max(0.f, hit.normal.dot(lights_.fill));
    gathered.base += hit.base;
    gathered.normal += hit.normal;
    gathered.position += hit.position;
    gathered.coverage += 1;
    gathered.key_visible += key.tfar[s] >= 0 ? 1.f : 0.f;
    gathered.sky_visible += sky.tfar[s] >= 0 ? sky_light[s] : 0.f;
  }
}

/// How much of the light a thin thing keeps. Lashes are modelled as solid cards whose texture would show hairs: without one,
/// more than half passes.
float Tracer::opacity(const RTCRayHit16& rays, int s) const {
  const int triangle = scene_.triangle_of(rays.hit.geomID[s], rays.hit.primID[s]);
  const Look& look = looks_[scene_.looks[triangle]];
  if (look.texture < 0 || look.alpha.mode == AlphaMode::opaque) return 7.f / samples;
  const Vec corners(1 - rays.hit.u[s] - rays.hit.v[s], rays.hit.u[s], rays.hit.v[s]);
  const float alpha = texture_color(look, triangle, corners)[3];
  return look.alpha.mode == AlphaMode::blend ? alpha : alpha < look.alpha.cutoff ? 0.f : 1.f;
}

/// Rays go on behind thin things, each at its own opacity: the sixteen of a pixel show the mixture. More than eight layers
/// are solid.
void Tracer::see_through(RTCRayHit16& rays, int cell) const {
  for (int layer = 0; layer < 8; ++layer) {
    alignas(64) std::array<int, samples> passes;
    bool any = false;
    for (int s = 0; s < samples; ++s) {
      const bool thin = rays.hit.geomID[s] == 1;
      const float stratum = (static_cast<float>((s * 7 + cell * 3) % samples) + 0.5f) / samples;
      passes[s] = thin && stratum > opacity(rays, s) ? -1 : 0;
      if (!passes[s]) continue;
      any = true;
      rays.ray.tnear[s] = rays.ray.tfar[s] + offset;
      rays.ray.tfar[s] = std::numeric_limits<float>::infinity();
      rays.hit.geomID[s] = RTC_INVALID_GEOMETRY_ID;
    }
    if (!any) return;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect16(passes.data(), scene_.all(), &context, &rays);
  }
}

Gathered Tracer::gather(int x, int y) const {
  alignas(64) RTCRayHit16 rays;
  alignas(64) std::array<int, samples> valid;
  valid.fill(-1);
  for (int s = 0; s < samples; ++s) {
    // A 4 x 4 grid turned a little, so that upright and level edges get sixteen steps.
    const float dx = (static_cast<float>(s % 4) + (static_cast<float>(s / 4) + 0.5f) / 4) / 4;
    const float dy = (static_cast<float>(s / 4) + (static_cast<float>(s % 4) + 0.5f) / 4) / 4;
    set_ray(rays.ray, s, lens_.eye, lens_.ray(static_cast<float>(x) + dx, static_cast<float>(y) + dy));
    rays.hit.geomID[s] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), scene_.all(), &context, &rays);
  see_through(rays, cell_of(x, y));
  std::array<Hit, samples> hits;
  bool any = false;
  for (int s = 0; s < samples; ++s) {
    valid[s] = surface(rays, s, hits[s]) ? -1 : 0;
    any = any || valid[s];
  }
  Gathered gathered;
  if (!any) return gathered;
  shade(hits, valid, cell_of(x, y), gathered);
  const float count = gathered.coverage;
  gathered.normal.normalize();
  gathered.position /= count;
  gathered.key_visible /= count;
  gathered.sky_visible /= count;
  return gathered;
}

/// Some rows of gathered pixels: a large picture is traced band by band, so that memory stays small.
struct Band {
  int first = 0, last = 0;  // rows [first, last)
  int width = 0;
  std::vector<Gathered> pixels;
  const Gathered& at(int x, int y) const { return pixels[static_cast<std::size_t>(y - first) * width + x]; }
  bool holds(int x, int y) const { return x >= 0 && x < width && y >= first && y < last; }
};

constexpr int filter_reach = 2;  // pixels

/// Visibility averaged over the neighbours that lie on the same surface.
Eigen::Vector2f filtered(const Band& band, const Lens& lens, int x, int y) {
  const Gathered& here = band.at(x, y);
  const float reach = 1.5f * lens.pixel((here.position - lens.eye).norm());
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  float total = 0;
  for (int dy = -filter_reach; dy <= filter_reach; ++dy)
    for (int dx = -filter_reach; dx <= filter_reach; ++dx) {
      if (!band.holds(x + dx, y + dy)) continue;
      const Gathered& there = band.at(x + dx, y + dy);
      if (there.coverage == 0) continue;
      const float off = std::abs((there.position - here.position).dot(here.normal)) / reach;
      const float turn = std::max(0.f, here.normal.dot(there.normal));
      // Half weight on the rim: every stratum of the block counts the same.
      const float rim =
          (std::abs(dx) == filter_reach ? 0.5f : 1.f) * (std::abs(dy) == filter_reach ? 0.5f : 1.f);
      const float weight =
          rim * std::exp(-off * off) * std::pow(turn, 12.f) + (dx == 0 && dy == 0 ? 1e-6f : 0.f);
      sum += weight * Eigen::Vector2f(there.key_visible, there.sky_visible);
      total += weight;
    }
  return sum / total;
}

/// Sky light in a cavity is also reflected by its walls, in their colour (Jimenez et al. 2016, Practical
/// Real-Time Strategies for Accurate Indirect Occlusion).
Vec with_bounces(float visible, const Vec& base) {
  const auto one = [&](float a) {
    const float p = 2.0404f * a - 0.3324f, q = -4.7951f * a + 0.6417f, r = 2.7552f * a + 0.6903f;
    return std::max(visible, ((visible * p + q) * visible + r) * visible);
  };
  return {one(base.x()), one(base.y()), one(base.z())};
}

float display(float linear) {
  // Straight up to a half, then a shoulder that never quite reaches white: light skins keep their modelling.
  const float x = linear <= 0.5f ? linear : 0.5f + 0.5f * (1 - std::exp(-(linear - 0.5f) / 0.5f));
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

Vec pixel_color(const Gathered& gathered, const Eigen::Vector2f& visible) {
  const Vec sky = with_bounces(visible.y(), gathered.base / gathered.coverage);
  return (gathered.key * visible.x() + gathered.fill * visible.y() +
          gathered.base.cwiseProduct(sky_color.cwiseProduct(sky))) /
         gathered.coverage;
}

Band gather_band(const Tracer& tracer, int first, int last, int width) {
  Band band{first, last, width, {}};
  band.pixels.resize(static_cast<std::size_t>(last - first) * width);
  parallel_for(last - first, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < width; ++x)
        band.pixels[row * width + x] = tracer.gather(x, first + static_cast<int>(row));
  });
  return band;
}

void compose_pixel(const Band& band, const Lens& lens, int x, int y, Picture& picture) {
  const Gathered& gathered = band.at(x, y);
  if (gathered.coverage == 0) return;
  const Vec color = pixel_color(gathered, filtered(band, lens, x, y));
  const float share = gathered.coverage / samples;
  std::uint8_t* pixel = picture.rgba.data() + 4 * (static_cast<std::size_t>(y) * picture.width + x);
  for (int k = 0; k < 3; ++k) {
    const float value = 255 * share * display(color[k]) + (1 - share) * static_cast<float>(pixel[k]);
    pixel[k] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.f, 255.f)));
  }
}

}  // namespace

Picture trace(const RayScene& scene, const Soup& soup, const Lens& lens, const TraceOptions& options) {
  Picture picture = blank_picture(lens.width, lens.height, options.background);
  const Tracer tracer(scene, soup, lens, options);
  const int rows = std::max(16, (1 << 20) / lens.width);
  for (int begin = 0; begin < lens.height; begin += rows) {
    const int end = std::min(begin + rows, lens.height);
    const Band band = gather_band(tracer, std::max(0, begin - filter_reach),
                                  std::min(lens.height, end + filter_reach), lens.width);
    parallel_for(end - begin, 4, [&](std::size_t from, std::size_t to) {
      for (std::size_t row = from; row < to; ++row)
        for (int x = 0; x < lens.width; ++x)
          compose_pixel(band, lens, x, begin + static_cast<int>(row), picture);
    });
  }
  return picture;
}

}  // namespace mien::detail
