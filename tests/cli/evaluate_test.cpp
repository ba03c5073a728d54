// mien evaluate: a pose or a clip into files.

#include "mien/evaluate/evaluate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "mien/character/sliders.h"
#include "mien/io/load.h"
#include "mien/io/weights_file.h"

namespace mien::test {
namespace {

class evaluate_command : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_mien(folder, "sample human --quiet -o " + folder.path().string()).exit_code, 0);
    folder.write("smile.json", R"({"weights": {"mouthSmileLeft": 0.8, "jawOpen": 0.25}})");
  }
  Ran evaluate(const std::string& arguments) {
    return run_mien(folder, "evaluate " + face + " " + arguments);
  }
  void expect_fails(const std::string& arguments, const std::string& says) {
    const Ran ran = evaluate(arguments);
    EXPECT_EQ(ran.exit_code, 1) << arguments;
    EXPECT_NE(ran.err.find(says), std::string::npos) << ran.err;
  }
  const Folder folder;
  const std::string face = folder / "human.glb";
  const std::string smile = " --weights " + folder / "smile.json";
};

/// The numbers of a .npy, and its header.
std::vector<float> numbers_of(const std::string& path, std::string& header) {
  const std::string bytes = text_of(path);
  if (bytes.size() < 10 || bytes.compare(1, 5, "NUMPY") != 0) return {};
  const std::size_t start =
      10 + static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ(start % 64, 0u);
  header = bytes.substr(10, start - 10);
  std::vector<float> numbers((bytes.size() - start) / 4);
  std::memcpy(numbers.data(), bytes.data() + start, 4 * numbers.size());
  return numbers;
}

double distance(const std::vector<Points>& posed, const float* at) {
  double most = 0;
  for (const Points& points : posed) {
    most = std::max<double>(most,
                            (points - Eigen::Map<const Points>(at, points.rows(), 3)).cwiseAbs().maxCoeff());
    at += points.size();
  }
  return most;
}

TEST_F(evaluate_command, says_what_is_wrong) {
  const std::string out = " -o " + folder / "out.npy";
  expect_fails(out, "for neither; --weights or --clip");
  expect_fails("--clip nobody" + out, "clip nobody: does not exist; one of ");
  expect_fails("--clip talk --fps 0" + out, "--fps: is 0; a positive number");
  expect_fails("--clip talk --fps nan" + out, "--fps: is nan");
  expect_fails("--clip talk --fps 1e12" + out, "a frame rate");
  expect_fails("--clip talk -o " + folder / "out.obj", "holds one pose");
  expect_fails(smile + " -o " + folder / "out.txt", "is no file that mien evaluates into");
  expect_fails("--weights " + folder / "nobody.json" + out, "nobody.json");
  folder.write("wrong.json", R"({"weights": {"mouthSmileLfet": 1}})");
  expect_fails("--weights " + folder / "wrong.json" + out, "mouthSmileLeft");
  expect_fails(smile + " -o " + folder / "no/such/out.npy", "out.npy");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.npy"));
}

TEST_F(evaluate_command, a_pose_is_what_the_library_gives) {
  const Character character = load(face);
  RigPose rig = rest_rig_pose(character);
  rig.sliders = read_weights(folder / "smile.json", character);
  const auto posed = mien::evaluate(character, pose_of(character, rig));
  for (const char* name : {"out.obj", "out.glb"}) {
    ASSERT_EQ(evaluate("--quiet" + smile + " -o " + folder / name).exit_code, 0);
    const Character still = load(folder / name);
    std::vector<float> all;
    for (const Part& part : still.parts)
      all.insert(all.end(), part.mesh.positions.data(),
                 part.mesh.positions.data() + part.mesh.positions.size());
    EXPECT_LT(distance(posed, all.data()), 1e-6) << name;
    EXPECT_TRUE(still.shapes.empty());
  }
  ASSERT_EQ(evaluate("--quiet" + smile + " -o " + folder / "out.npy").exit_code, 0);
  std::string header;
  EXPECT_LT(distance(posed, numbers_of(folder / "out.npy", header).data()), 1e-5);
}

TEST_F(evaluate_command, a_clip_is_one_array_or_a_folder) {
  const Character character = load(face);
  ASSERT_FALSE(character.clips.empty());
  const Clip& clip = character.clips[0];
  const std::string asked = "--clip " + clip.name + " --fps 5";
  const Ran ran = evaluate(asked + " --compact --json -o " + folder / "clip.npy");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto report = nlohmann::json::parse(ran.out);
  const auto frames = report["frames"].get<std::size_t>(), vertices = report["vertices"].get<std::size_t>();
  EXPECT_EQ(frames, static_cast<std::size_t>(std::floor(clip.duration() * 5 + 1e-6)) + 1);
  EXPECT_GT(report["compact_error"].get<double>(), 0);
  std::string header;
  const std::vector<float> numbers = numbers_of(folder / "clip.npy", header);
  EXPECT_NE(header.find("'<f4', 'fortran_order': False, 'shape': (" + std::to_string(frames) + ", " +
                        std::to_string(vertices) + ", 3, )"),
            std::string::npos)
      << header;
  ASSERT_EQ(numbers.size(), frames * vertices * 3);
  for (std::size_t f = 0; f < frames; f += 4)
    EXPECT_LT(distance(mien::evaluate(character, sample_clip(character, clip, static_cast<double>(f) / 5)),
                       numbers.data() + f * vertices * 3),
              1e-4);
  ASSERT_EQ(evaluate(asked + " --quiet -o " + folder / "frames").exit_code, 0);
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "frames"))
    count += entry.path().extension() == ".obj";
  EXPECT_EQ(count, frames);
}

}  // namespace
}  // namespace mien::test
