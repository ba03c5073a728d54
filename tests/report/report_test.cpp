#include "mien/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/report/detail/html.h"
#include "mien/report/thesis_times.h"
#include "mien/sample/sample.h"
#include "mien/transfer/transfer.h"

namespace mien {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// The built-in human with the named shapes alone: a report draws every shape twice.
Character human_with(const std::set<std::string>& names) {
  Character human = make_sample("human");
  std::vector<Shape> kept;
  std::vector<int> place(human.shapes.size(), -1);
  for (std::size_t s = 0; s < human.shapes.size(); ++s) {
    if (!names.contains(human.shapes[s].name)) continue;
    place[s] = static_cast<int>(kept.size());
    kept.push_back(human.shapes[s]);
  }
  human.shapes = kept;
  human.sliders.clear();
  complete_sliders(human);
  for (Clip& clip : human.clips) {
    std::vector<Channel> channels;
    for (Channel channel : clip.channels) {
      if (channel.shape >= 0) channel.shape = place[static_cast<std::size_t>(channel.shape)];
      if (channel.property != Channel::Property::shape_weight || channel.shape >= 0)
        channels.push_back(channel);
    }
    clip.channels = channels;
  }
  return human;
}

/// Two shapes on the cartoon.
struct Transferred {
  Character source = human_with({"jawOpen", "eyeBlinkLeft"}), target = make_sample("cartoon");
  TransferResult result = transfer(source, target);
};

std::string error_of(const Character& source, const Character& target, const TransferResult& result) {
  try {
    make_report({source, target, result, {}});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "no error";
}

TEST(Report, InvalidInputs) {
  const Transferred t;
  EXPECT_THAT(error_of({}, t.target, t.result), HasSubstr("report: the result has other source parts than"));
  EXPECT_THAT(error_of(t.source, {}, t.result), HasSubstr("other target parts"));
  Character other = t.source;
  other.shapes.pop_back();
  EXPECT_THAT(error_of(other, t.target, t.result), HasSubstr("other shapes"));
  other = t.source;
  other.parts[0].mesh.positions.conservativeResize(10, 3);
  EXPECT_THAT(error_of(other, t.target, t.result), HasSubstr("other source vertices"));
  const auto stop = [](std::string_view, double) { return false; };
  try {
    make_report({t.source, t.target, t.result, {}, "a", "b", "c", stop});
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::cancelled);
  }
}

void expect_self_contained(const std::string& html) {
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  for (const char* outside : {"<script", "<link", "<iframe", "url(", "@import"})
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  int pictures = 0;
  for (std::size_t at = html.find(" src="); at != std::string::npos;
       at = html.find(" src=", at + 1), ++pictures)
    ASSERT_THAT(html.substr(at, 30), StartsWith(" src=\"data:image/png;base64,"));
  EXPECT_GT(pictures, 20);
  for (std::size_t at = html.find(" href="); at != std::string::npos; at = html.find(" href=", at + 1))
    ASSERT_EQ(html[at + 7], '#');
}

void expect_escaped_names(const std::string& html) {
  EXPECT_THAT(html, HasSubstr("&lt;source&gt;.glb on target.obj"));
  EXPECT_THAT(html, HasSubstr("jaw &lt;b&gt;&amp;&quot;open&quot;&lt;/b&gt;\xEF\xBF\xBD\xEF\xBF\xBD"));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;"));
}

void expect_all_sections(const std::string& html) {
  for (const char* id : {"surfaces", "maps", "shapes", "baseline", "weights", "clips", "pieces", "seconds"})
    EXPECT_THAT(html, HasSubstr(std::string("<h2 id=\"") + id + "\""));
}

void expect_numbers_of(const TransferReport& report, const nlohmann::json& json) {
  EXPECT_EQ(json["source"], "<source>.glb");
  EXPECT_EQ(json["method"], "register");
  EXPECT_EQ(json["landmarks"]["count"], report.pairs.names.size());
  EXPECT_EQ(json["scale"], report.similarity.scale);
  EXPECT_EQ(json["deltas"]["reason"], report.deltas.reason);
  ASSERT_EQ(json["shapes"].size(), 2u);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(json["shapes"][s]["flips"]["target"], report.flips[s]);
    EXPECT_EQ(json["shapes"][s]["flips"]["source"], report.source_flips[s]);
    EXPECT_GE(json["shapes"][s]["worst_stretch"]["target"], 1);
    EXPECT_GT(json["shapes"][s]["thesis"]["difference"], 0);
  }
  EXPECT_EQ(json["seconds"].size(), report.steps.size());
  EXPECT_EQ(json["pieces"].size(), report.pieces.size());
  EXPECT_FALSE(json["joints"].empty());
  ASSERT_FALSE(json["clips"].empty());
  const auto& curve = json["clips"][0]["joints"][0];
  EXPECT_EQ(curve["epsilon"]["source"].size(), json["clips"][0]["seconds"].size());
  EXPECT_GT(curve["transferred"]["correlation"], 0.9) << "the transferred clip follows the source's";
}

void expect_thesis_times_of(const TransferReport& report, const nlohmann::json& json) {
  std::set<std::string_view> steps;
  for (const StepTime& step : report.steps) steps.insert(step.step);
  for (const ThesisStep& step : thesis_steps())
    EXPECT_TRUE(step.step.empty() || steps.contains(step.step)) << step.step;
  EXPECT_EQ(json["thesis_tables"]["Joints Transfer"]["Fantastic"], 19.18);
}

TEST(Report, TellsEverythingOfAFullRig) {
  Transferred t;
  t.source.shapes[1].name = t.result.character.shapes[1].name = "jaw <b>&\"open\"</b>\x01\xff";
  t.result.report.warnings.push_back({"<script>alert(1)</script>", "remove it"});
  const Report report =
      make_report({t.source, t.target, t.result, {}, "<source>.glb", "target.obj", "out.glb"});
  expect_self_contained(report.html);
  expect_escaped_names(report.html);
  expect_all_sections(report.html);
  const auto json = nlohmann::json::parse(report.json);
  expect_numbers_of(t.result.report, json);
  expect_thesis_times_of(t.result.report, json);
}

TEST(Report, JointsAloneByTheBaselineLeaveSectionsOut) {
  const Character source = human_with({}), target = make_sample("creature");
  TransferOptions options;
  options.method = TransferMethod::thesis;
  const TransferResult result = transfer(source, target, options);
  const Report report = make_report({source, target, result, options});
  for (const char* id : {"shapes", "baseline"})
    EXPECT_THAT(report.html, Not(HasSubstr("#" + std::string(id)))) << "nor a link to what is not there";
  EXPECT_THAT(report.html, HasSubstr("<h2 id=\"weights\""));
  EXPECT_FALSE(nlohmann::json::parse(report.json).contains("thesis"));
  EXPECT_EQ(report.html, make_report({source, target, result, options}).html)
      << "the same input gives the same page";
}

TEST(Html, EscapesAndEncodes) {
  EXPECT_EQ(detail::escaped("a<b>&\"'\n\x7f"), "a&lt;b&gt;&amp;&quot;&#39; \xEF\xBF\xBD");
  EXPECT_EQ(detail::escaped("\xc3\xa9\xc3"), "\xc3\xa9\xEF\xBF\xBD");
  EXPECT_EQ(detail::escaped("\xed\xa0\x80").size(), 9u) << "a surrogate is three broken bytes";
  const auto base64 = [](const std::string& text) { return detail::base64({text.begin(), text.end()}); };
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace mien
