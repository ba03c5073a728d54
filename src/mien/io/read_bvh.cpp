// Biovision Hierarchy: joints with offsets, then rows of channel values in degrees. A joint's rotation is the
// product of its channels' in the order in which the file lists them.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "mien/core/error.h"
#include "mien/io/capture_file.h"
#include "mien/io/file.h"

namespace mien {
namespace {

constexpr int most_joints = 10'000;
constexpr int most_depth = 500;
constexpr double most_values = 50e6;

/// One column of the motion rows.
struct Column {
  int joint = 0;
  bool turns = false;  ///< rotation, otherwise position
  int axis = 0;
};

class BvhReader {
 public:
  explicit BvhReader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}
  Character read();

 private:
  std::string_view word(const char* wanted);
  void expect(std::string_view wanted);
  double number(const char* what);
  int count(const char* what, int most);
  Eigen::Vector3d offset();
  void read_joint(int parent, int depth);
  void read_channels(int joint);
  void read_end_site();
  void read_motion();
  Clip clip_of(const std::vector<std::vector<Transform>>& frames, double frame_time) const;
  Error wrong(std::string_view problem, std::string_view remedy) const {
    return io_error(fmt::format("line {}", line_), problem, remedy);
  }

  const char *at_, *end_;
  int line_ = 1;
  Character character_;
  std::vector<Column> columns_;
  std::vector<char> moves_;  ///< per joint: it has position channels
};

std::string_view BvhReader::word(const char* wanted) {
  while (at_ < end_ && static_cast<unsigned char>(*at_) <= ' ') line_ += *at_++ == '\n';
  const char* begin = at_;
  while (at_<end_&& static_cast<unsigned char>(*at_)> ' ') ++at_;
  if (begin == at_) throw wrong("ends early", fmt::format("{} is missing", wanted));
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

void BvhReader::expect(std::string_view wanted) {
  const std::string name(wanted);
  if (const std::string_view found = word(name.c_str()); found != wanted)
    throw wrong(fmt::format("has \"{}\"", found.substr(0, 40)), fmt::format("{} belongs here", wanted));
}

double BvhReader::number(const char* what) {
  const std::string_view text = word(what);
  double value = 0;
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || rest != text.data() + text.size() || !std::isfinite(value))
    throw wrong(fmt::format("has \"{}\"", text.substr(0, 40)), fmt::format("give {}", what));
  return value;
}

int BvhReader::count(const char* what, int most) {
  const double value = number(what);
  if (value < 0 || value > most || value != std::floor(value))
    throw wrong(fmt::format("has {}", value), fmt::format("give {} from 0 to {}", what, most));
  return static_cast<int>(value);
}

Eigen::Vector3d BvhReader::offset() {
  expect("OFFSET");
  const double x = number("a number"), y = number("a number"), z = number("a number");
  return {x, y, z};
}

void BvhReader::read_channels(int joint) {
  const int channels = count("a number of channels", 6);
  for (int k = 0; k < channels; ++k) {
    const std::string_view name = word("a channel");
    const auto axis = name.empty() ? std::string_view::npos : std::string_view("XYZ").find(name.front());
    const std::string_view kind = name.substr(1);
    if (axis == std::string_view::npos || (kind != "position" && kind != "rotation"))
      throw wrong(fmt::format("has channel \"{}\"", name.substr(0, 40)), "give Xposition ... Zrotation");
    columns_.push_back({joint, kind == "rotation", static_cast<int>(axis)});
    if (kind == "position") moves_[static_cast<std::size_t>(joint)] = 1;
  }
}

void BvhReader::read_end_site() {
  expect("Site");
  expect("{");
  offset();
  expect("}");
}

void BvhReader::read_joint(int parent, int depth) {
  if (character_.nodes.size() >= most_joints || depth > most_depth)
    throw wrong("has too many joints", fmt::format("at most {}, {} deep", most_joints, most_depth));
  const int joint = static_cast<int>(character_.nodes.size());
  Node node;
  node.name = word("a joint's name");
  node.parent = parent;
  expect("{");
  node.rest.translation = offset();
  character_.nodes.push_back(std::move(node));
  moves_.push_back(0);
  for (;;) {
    const std::string_view next = word("}");
    if (next == "}") return;
    if (next == "CHANNELS")
      read_channels(joint);
    else if (next == "JOINT")
      read_joint(joint, depth + 1);
    else if (next == "End")
      read_end_site();
    else
      throw wrong(fmt::format("has \"{}\"", next.substr(0, 40)), "give CHANNELS, JOINT, End or }");
  }
}

Clip BvhReader::clip_of(const std::vector<std::vector<Transform>>& frames, double frame_time) const {
  Clip clip;
  clip.name = "motion";
  const auto channel_of = [&](std::size_t joint, Channel::Property property, const auto& append) {
    Channel channel;
    channel.property = property;
    channel.node = static_cast<int>(joint);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      channel.times.push_back(static_cast<float>(static_cast<double>(f) * frame_time));
      append(frames[f][joint], channel.values);
    }
    clip.channels.push_back(std::move(channel));
  };
  for (std::size_t joint = 0; joint < character_.nodes.size(); ++joint) {
    if (moves_[joint])
      channel_of(joint, Channel::Property::translation, [](const Transform& t, std::vector<float>& values) {
        for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(t.translation[k]));
      });
    channel_of(joint, Channel::Property::rotation, [](const Transform& t, std::vector<float>& values) {
      for (int k = 0; k < 4; ++k) values.push_back(static_cast<float>(t.rotation.coeffs()[k]));
    });
  }
  return clip;
}

void BvhReader::read_motion() {
  expect("MOTION");
  expect("Frames:");
  const int frames = count("a number of frames", 10'000'000);
  expect("Frame");
  expect("Time:");
  const double frame_time = number("seconds a frame");
  if (!(frame_time > 0))
    throw wrong(fmt::format("has a frame time of {}", frame_time), "give seconds above 0");
  const double values = static_cast<double>(frames) * static_cast<double>(columns_.size());
  // Every value takes two bytes of the file at least, so a small file cannot ask for a large memory.
  if (values > most_values || 2 * values > static_cast<double>(end_ - at_) + 2)
    throw wrong(fmt::format("announces {} frames", frames), "give as many as the rows that follow");
  std::vector<std::vector<Transform>> motion;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Transform> locals;
    for (const Node& node : character_.nodes) locals.push_back(node.rest);
    for (const Column& column : columns_) {
      Transform& local = locals[static_cast<std::size_t>(column.joint)];
      const double value = number("a channel's value");
      if (column.turns)
        local.rotation = local.rotation * Eigen::AngleAxisd(value * std::numbers::pi / 180,
                                                            Eigen::Vector3d::Unit(column.axis));
      else
        local.translation[column.axis] = value;
    }
    motion.push_back(std::move(locals));
  }
  if (frames > 0) character_.clips.push_back(clip_of(motion, frame_time));
}

Character BvhReader::read() {
  expect("HIERARCHY");
  expect("ROOT");
  read_joint(-1, 0);
  read_motion();
  return std::move(character_);
}

}  // namespace

Character read_bvh(const std::filesystem::path& path) {
  try {
    const std::vector<std::uint8_t> bytes = read_file(path);
    return BvhReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).read();
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
