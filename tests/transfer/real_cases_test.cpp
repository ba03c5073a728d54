// Transfers whose truth is known: re-tessellated, moved, turned and scaled heads of two public libraries.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "transfer/load_marked.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

template <typename Number>
std::vector<Number> numbers_of(const std::string& bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}
/// The numbers of a NumPy file of floats, halves or truth values.
std::vector<float> read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 10> head{};
  file.read(head.data(), head.size());
  const std::size_t length = static_cast<unsigned char>(head[8]) + 256u * static_cast<unsigned char>(head[9]);
  std::string header(length, ' ');
  file.read(header.data(), static_cast<std::streamsize>(length));
  EXPECT_NE(header.find("'fortran_order': False"), std::string::npos) << header;
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto as_floats = [](const auto& numbers) {
    return std::vector<float>(numbers.begin(), numbers.end());
  };
  if (header.find("'<f4'") != std::string::npos) return numbers_of<float>(bytes);
  if (header.find("'<f2'") != std::string::npos) return as_floats(numbers_of<Eigen::half>(bytes));
  if (header.find("'|b1'") != std::string::npos) return as_floats(numbers_of<signed char>(bytes));
  ADD_FAILURE() << path << " holds other numbers: " << header;
  return {};
}

struct Case {
  Character source, target;
  std::vector<std::string> names;
  std::vector<float> truth;   ///< shapes x vertices x 3
  std::vector<float> region;  ///< per vertex of the target, 1 on the outer skin
};

Case load_case(const std::filesystem::path& folder) {
  Case loaded;
  loaded.source = load_marked(folder / "source.glb", folder / "source_landmarks.json");
  loaded.target = load_marked(folder / "target.obj", folder / "target_landmarks.json");
  std::ifstream names(folder / "names.json");
  loaded.names = nlohmann::json::parse(names).get<std::vector<std::string>>();
  loaded.truth = read_npy(folder / "truth.npy");
  loaded.region = read_npy(folder / "region.npy");
  return loaded;
}

/// Shapes' displacements of all parts' vertices in file order, #V x 3.
PointsD all_deltas(const Character& character, const std::string& shape) {
  std::size_t count = 0;
  for (const Part& part : character.parts) count += part.mesh.vertex_count();
  PointsD deltas = PointsD::Zero(static_cast<Eigen::Index>(count), 3);
  const int index = find_shape(character, shape);
  EXPECT_GE(index, 0) << shape;
  Eigen::Index first = 0;
  for (std::size_t p = 0; p < character.parts.size() && index >= 0; ++p) {
    const PointsD part = delta_of(character, static_cast<std::size_t>(index), static_cast<int>(p));
    deltas.middleRows(first, part.rows()) = part;
    first += part.rows();
  }
  return deltas;
}

/// Median over shapes of RMS(got - true) / RMS(true) over the outer skin; shapes that move less than 20 of its vertices
/// are left out.
double median_error(const Case& known, const Character& result) {
  const Eigen::Index count = static_cast<Eigen::Index>(known.region.size());
  std::vector<double> errors;
  for (std::size_t s = 0; s < known.names.size(); ++s) {
    const PointsD got = all_deltas(result, known.names[s]);
    EXPECT_EQ(got.rows(), count);
    const Eigen::Map<const Points> truth(known.truth.data() + 3 * s * known.region.size(), count, 3);
    double off = 0, size = 0, largest = 0;
    for (Eigen::Index v = 0; v < count; ++v) {
      if (known.region[v] == 0) continue;
      off += (got.row(v) - truth.row(v).cast<double>()).squaredNorm();
      size += truth.row(v).cast<double>().squaredNorm();
      largest = std::max(largest, double(truth.row(v).norm()));
    }
    int moved = 0;
    for (Eigen::Index v = 0; v < count; ++v)
      moved += known.region[v] != 0 && truth.row(v).norm() > 0.02 * std::max(largest, 1e-12);
    if (moved >= 20) errors.push_back(std::sqrt(off / size));
  }
  std::sort(errors.begin(), errors.end());
  const std::size_t half = errors.size() / 2;
  return errors.size() % 2 ? errors[half] : (errors[half - 1] + errors[half]) / 2;
}

/// The default is at least this good; the thesis's method is what it was published to be, within a quarter.
void expect_errors(const std::string& name, double largest, double thesis) {
  const auto folder = std::filesystem::path(MIEN_SHARED_DATA) / "cases" / name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data";
  const Case known = load_case(folder);
  const double got = median_error(known, transfer(known.source, known.target).character);
  EXPECT_LE(got, largest);
  TransferOptions options;
  options.method = TransferMethod::thesis;
  const double baseline = median_error(known, transfer(known.source, known.target, options).character);
  EXPECT_NEAR(baseline, thesis, thesis / 4);
}

TEST(real_cases, another_identity_of_one_library) {
  expect_errors("A1_ict_id1.0", 0.052, 0.125);
}

TEST(real_cases, artists_shapes_on_another_face) {
  expect_errors("B1_mh_african", 0.174, 0.374);
}

TEST(real_cases, shapes_made_by_joints_on_another_face) {
  expect_errors("C_mhrig_afr", 0.185, 0.473);
}

}  // namespace
}  // namespace mien::test
