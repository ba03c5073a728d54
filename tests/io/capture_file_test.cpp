#include "mien/io/capture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "mien/character/pose.h"
#include "mien/io/name_map_file.h"
#include "support.h"

namespace mien {
namespace {

using test::error_of;
using test::Folder;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(read_slider_csv, broken_files_are_named_with_line_and_column) {
  const std::pair<const char*, const char*> table[] = {
      {"", "file: has no rows"},
      {"time,jaw\n", "file: has no rows"},
      {"time,jaw\n0,1\n1\n", "line 3: has 1 cells; the header has 2"},
      {"time,jaw\n0,much\n", "line 2, column jaw: is \"much\"; give a number"},
      {"time,jaw\n0,1e999\n", "line 2, column jaw: is \"1e999\""},
      {"time,jaw\n1,0\n1,0\n", "line 3, column time: is \"1\"; times must be later"},
      {"time,jaw,jaw\n0,0,0\n", "header: names jaw twice"},
      {"time\n0\n", "header: names no slider"},
      {"Timecode,jaw\n12:00,1\n", "line 2, column Timecode: is \"12:00\"; give a timecode"},
  };
  for (const auto& [text, expected] : table) {
    const Folder folder;
    const auto path = folder.write("take.csv", text);
    EXPECT_THAT(error_of([&] { read_slider_csv(path); }), HasSubstr(expected)) << text;
  }
  const Folder folder;
  EXPECT_THAT(error_of([&] { capture_kind(folder.write("take.c3d", "")); }),
              HasSubstr("is not known; name a .csv"));
  EXPECT_THAT(error_of([&] { read_slider_csv(folder.write("a.csv", "jaw\n1\n"), 0); }),
              HasSubstr("rate: is 0"));
}

TEST(read_slider_csv, reads_live_link_timecodes_and_leaves_the_count_out) {
  const Folder folder;
  const SliderTake take = read_slider_csv(folder.write("take.csv",
                                                       "Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen\r\n13:"
                                                       "13:04:59.5,2,0.5,0.25\r\n13:13:05:01.5,2,,1.02\r\n"));
  EXPECT_THAT(take.names, ElementsAre("EyeBlinkLeft", "JawOpen"));
  EXPECT_EQ(take.seconds[0], 0);
  EXPECT_NEAR(take.seconds[1], 2 / 60.0, 1e-9);
  EXPECT_EQ(take.values(1, 0), 0.5) << "a gap keeps the last value";
  EXPECT_EQ(take.values(1, 1), 1.02);
}

TEST(read_slider_csv, counts_frames_where_the_file_has_no_times) {
  const Folder folder;
  EXPECT_THAT(read_slider_csv(folder.write("a.csv", "jaw;lip\n0;1\n1;0\n"), 25).seconds,
              ElementsAre(0, 0.04));
  EXPECT_THAT(read_slider_csv(folder.write("b.csv", "# by us\nframe\tjaw\n10\t0\n20\t1\n"), 100).seconds,
              ElementsAre(0, 0.1));
}

TEST(read_marker_csv, gaps_are_unseen) {
  const Folder folder;
  const auto path = folder.write(
      "m.csv", "frame,nose.x,nose.y,nose.z,chin_X,chin_Y,chin_Z\n0,1,2,3,4,5,6\n1,1,2,3,,,NaN\n");
  EXPECT_EQ(capture_kind(path), CaptureKind::markers);
  const MarkerTake take = read_marker_csv(path);
  EXPECT_THAT(take.names, ElementsAre("nose", "chin"));
  EXPECT_EQ(take.positions[0].row(1), Eigen::RowVector3d(4, 5, 6));
  EXPECT_THAT(take.seen[1], ElementsAre(1, 0));
  EXPECT_THAT(error_of([&] { read_marker_csv(folder.write("n.csv", "a.x,a.y,b.x,b.y,b.z\n1,1,1,1,1\n")); }),
              HasSubstr("marker a: has no z column"));
  EXPECT_THAT(error_of([&] { read_marker_csv(folder.write("o.csv", "jaw\n1\n")); }),
              HasSubstr("names no markers"));
}

constexpr const char* bvh = R"(HIERARCHY
ROOT hips
{
  OFFSET 0 10 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT head
  {
    OFFSET 0 5 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 2 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 10 0 0 0 0 0 0 0
1 11 2 90 0 0 0 90 0
)";

TEST(read_bvh, joints_and_motion_are_read) {
  const Folder folder;
  const Character character = read_bvh(folder.write("walk.bvh", bvh));
  ASSERT_EQ(character.nodes.size(), 2u);
  EXPECT_EQ(character.nodes[1].name, "head");
  EXPECT_EQ(character.nodes[1].parent, 0);
  EXPECT_EQ(character.nodes[1].rest.translation, Eigen::Vector3d(0, 5, 0));
  ASSERT_EQ(character.clips.size(), 1u);
  const Clip& clip = character.clips[0];
  ASSERT_EQ(clip.channels.size(), 3u);
  EXPECT_THAT(clip.channels[0].values, ElementsAre(0, 10, 0, 1, 11, 2));
  EXPECT_FLOAT_EQ(clip.channels[1].times[1], 0.04f);
  const float half = static_cast<float>(std::numbers::sqrt2 / 2);
  EXPECT_NEAR(clip.channels[1].values[6], half, 1e-6);
  EXPECT_NEAR(clip.channels[2].values[4], half, 1e-6);
}

TEST(read_bvh, broken_files_are_named_with_their_line) {
  const auto with = [](const char* from, const char* to) {
    std::string text = bvh;
    return text.replace(text.find(from), std::string_view(from).size(), to);
  };
  const std::pair<std::string, const char*> table[] = {
      {"", "line 1: ends early; HIERARCHY is missing"},
      {with("ROOT", "JOINT"), "line 2: has \"JOINT\"; ROOT belongs here"},
      {with("0 5 0", "0 nan 0"), "line 8: has \"nan\"; give a number"},
      {with("CHANNELS 3", "CHANNELS 7"), "line 9: has 7; give a number of channels from 0 to 6"},
      {with("Xrotation", "Wrotation"), "line 5: has channel \"Wrotation\""},
      {with("Frames: 2", "Frames: 2000000"), "announces 2000000 frames"},
      {with("Time: 0.04", "Time: 0"), "has a frame time of 0"},
      {with("1 11 2 90", "1 11 2 x"), "line 20: has \"x\"; give a channel's value"},
  };
  for (const auto& [text, expected] : table) {
    const Folder folder;
    const auto path = folder.write("walk.bvh", text);
    EXPECT_THAT(error_of([&] { read_bvh(path); }), HasSubstr(expected));
  }
  std::string deep = "HIERARCHY\nROOT a { OFFSET 0 0 0\n";
  for (int k = 0; k < 3000; ++k) deep += "JOINT b { OFFSET 0 0 0\n";
  const Folder folder;
  EXPECT_THAT(error_of([&] { read_bvh(folder.write("deep.bvh", deep)); }), HasSubstr("too many joints"));
}

TEST(read_name_map, names_and_gains) {
  const Folder folder;
  const auto names =
      read_name_map(folder.write("m.json", R"({"map": {"a": "b", "c": {"to": "d", "gain": 0.5}}})"));
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[1].to, "d");
  EXPECT_EQ(names[1].gain, 0.5);
  EXPECT_THAT(error_of([&] { read_name_map(folder.write("n.json", "{}")); }), HasSubstr("has no \"map\""));
  EXPECT_THAT(error_of([&] { read_name_map(folder.write("o.json", R"({"map": {"a": 3}})")); }),
              HasSubstr("map.a"));
}

TEST(read_slider_csv, the_range_of_motion_take) {
  const std::filesystem::path path = MIEN_SHARED_DATA "/mocap/livelink_range_of_motion.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data";
  const SliderTake take = read_slider_csv(path);
  EXPECT_EQ(take.values.rows(), 4030);
  EXPECT_EQ(take.names.size(), 61u);
  EXPECT_NEAR(take.seconds[1], 1 / 30.0, 1e-3);
}

}  // namespace
}  // namespace mien
