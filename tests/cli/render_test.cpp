// What `mien render` accepts, refuses and writes.

#include <gtest/gtest.h>

#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

/// A head of two shapes, as OBJs put together: a pyramid whose tip moves.
class Render : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string base = "v -1 0 0\nv 1 0 0\nv 0 1 0\n", faces = "f 1 2 4\nf 2 3 4\nf 3 1 4\n";
    folder.write("neutral.obj", base + "v 0 0.4 1\n" + faces);
    folder.write("smile.obj", base + "v 0.5 0.4 1\n" + faces);
    folder.write("frown.obj", base + "v 0 0.1 1\n" + faces);
    ASSERT_EQ(run_mien(folder, "assemble " + folder / "neutral.obj" + " " + folder / "smile.obj" + " " +
                                   folder / "frown.obj" + " --quiet -o " + face)
                  .exit_code,
              0);
  }
  Ran render(const std::string& arguments) const {
    const std::string size = arguments.find("--size") == std::string::npos ? " --size 48,48" : "";
    return run_mien(folder, "render " + face + size + " --quiet -o " + png + " " + arguments);
  }
  std::string bytes_of(const std::string& arguments) const {
    const Ran ran = render(arguments);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return text_of(png);
  }
  void refuse(const std::string& arguments, const std::string& part_of_text) const {
    SCOPED_TRACE(arguments);
    expect_failure(render(arguments), part_of_text);
    EXPECT_FALSE(std::filesystem::exists(png));
  }
  const Folder folder;
  const std::string face = folder / "face.glb", png = folder / "face.png";
};

TEST_F(Render, InvalidInputs) {
  refuse("--shape smirk", "face.glb: shape smirk: does not exist; name one of the 2 shapes, perhaps smile");
  refuse("--shape smile=wide", "--shape smile=wide: has no number after =");
  refuse("--shape smile=nan", "--shape smile=nan: has no number after =");
  refuse("--view behind", "view behind: does not exist; front, left, right or three-quarter");
  refuse("--clip talk", "clip talk: does not exist; the character has no clips");
  refuse("--zoom nose", "region nose: does not exist; mouth or eyes");
  refuse("--zoom eyes", "--zoom eyes: finds nothing named like it");
  refuse("--size 0,48", "0 x 48 pixels");
  refuse("--size 30000,48", "30000 x 48 pixels");
  folder.write("weights.json", "{\"weights\": {\"smile\": \"much\"}}");
  refuse("--weights " + folder / "weights.json", "weights.json: weights.smile: is a string; give a number");
  folder.write("weights.json", "{\"smile\": 1}");
  refuse("--weights " + folder / "weights.json", "has no \"weights\"");
  folder.write("weights.json", "{\"weights\":");
  refuse("--weights " + folder / "weights.json", "is not valid JSON");
  refuse("--weights " + folder / "none.json", "none.json: file: cannot be opened");
  expect_failure(run_mien(folder, "render " + face + " -o " + folder / "face.jpg"), "ends in .png");
}

TEST_F(Render, ShapesMoveTheFace) {
  const std::string neutral = bytes_of("");
  const std::string smile = bytes_of("--shape smile=1");
  EXPECT_NE(smile, neutral);
  EXPECT_EQ(bytes_of("--shape smile"), smile);
  EXPECT_EQ(bytes_of("--shape smile=0"), neutral);
  folder.write("weights.json", "{\"weights\": {\"smile\": 1}}");
  EXPECT_EQ(bytes_of("--weights " + folder / "weights.json"), smile);
  EXPECT_NE(bytes_of("--shape smile --shape frown=0.5"), smile);
}

TEST_F(Render, SameBytesAtOneAndTwoThreads) {
  EXPECT_EQ(bytes_of("--sheet --wireframe --threads 1"), bytes_of("--sheet --wireframe --threads 2"));
}

TEST_F(Render, SheetHoldsTheNeutralAndEveryShape) {
  const std::string sheet = bytes_of("--sheet");
  ASSERT_GT(sheet.size(), 24u);
  EXPECT_GE(static_cast<unsigned char>(sheet[19]), 2 * 48);
}

}  // namespace
}  // namespace mien::test
