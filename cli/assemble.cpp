#include "mien/io/assemble.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "command.h"
#include "mien/core/error.h"
#include "mien/io/load.h"

namespace mien::cli {
namespace {

namespace fs = std::filesystem;

struct AssembleArguments {
  std::vector<std::string> inputs;
  std::string neutral, output;
  std::vector<std::string> exclude;
  AssembleOptions options;
  SaveOptions save;
};

bool is_named_neutral(const fs::path& path) {
  std::string name = path.stem().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name.find("neutral") != name.npos;
}

/// The inputs with folders replaced by the OBJs in them, by name, without the excluded ones.
std::vector<fs::path> files_of(const AssembleArguments& arguments) {
  std::vector<fs::path> files;
  for (const std::string& input : arguments.inputs) {
    if (!fs::is_directory(input)) {
      files.emplace_back(input);
      continue;
    }
    std::vector<fs::path> inside;
    for (const fs::directory_entry& entry : fs::directory_iterator(input))
      if (entry.is_regular_file() &&
          (entry.path().extension() == ".obj" || entry.path().extension() == ".OBJ"))
        inside.push_back(entry.path());
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  std::erase_if(files, [&](const fs::path& file) {
    return std::any_of(arguments.exclude.begin(), arguments.exclude.end(), [&](const std::string& pattern) {
      return fnmatch(pattern.c_str(), file.filename().c_str(), 0) == 0;
    });
  });
  return files;
}

/// Takes the neutral out of the files: the one that --neutral names, else the first file given by name, else the one
/// in the folder whose name says so.
fs::path take_neutral(const AssembleArguments& arguments, std::vector<fs::path>& files) {
  if (!arguments.neutral.empty()) {
    std::error_code ignored;
    std::erase_if(files, [&](const fs::path& file) {
      return file == fs::path(arguments.neutral) || fs::equivalent(file, arguments.neutral, ignored);
    });
    return arguments.neutral;
  }
  auto found = files.begin();
  if (fs::is_directory(arguments.inputs[0]))
    found = std::find_if(files.begin(), files.end(), is_named_neutral);
  if (found == files.end())
    throw invalid_input("neutral", "is not among the files", "name it with --neutral FILE")
        .in_file(arguments.inputs[0]);
  const fs::path neutral = *found;
  files.erase(found);
  return neutral;
}

void run(const AssembleArguments& arguments, const Common& common) {
  AssembleOptions options = arguments.options;
  options.progress = progress_bar(common);
  std::vector<fs::path> files = files_of(arguments);
  const fs::path neutral = take_neutral(arguments, files);
  const Character character = assemble(neutral, files, options);
  save(character, arguments.output, arguments.save);
  std::size_t moved = 0;
  for (const Shape& shape : character.shapes) moved += shape.parts[0].vertices.size();
  const std::size_t vertices = character.parts[0].mesh.vertex_count();
  const double share =
      character.shapes.empty() ? 0 : double(moved) / double(character.shapes.size() * vertices);
  print_result(
      common,
      fmt::format("{}: {} vertices, {} shapes, {:.0f} % of the vertices move in a shape on average\n",
                  arguments.output, vertices, character.shapes.size(), 100 * share),
      {{"output", arguments.output},
       {"neutral", neutral.string()},
       {"vertices", vertices},
       {"shapes", character.shapes.size()},
       {"moving_share", share}});
}

}  // namespace

void add_assemble(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<AssembleArguments>();
  CLI::App* command = app.add_subcommand("assemble", "Make a character from whole-face OBJs of one topology");
  command->add_option("FILES", arguments->inputs, "The neutral, then one file a shape; or a folder of them")
      ->required();
  command->add_option("-o,--output", arguments->output, "The character: .glb or .gltf")->required();
  command->add_option(
      "--neutral", arguments->neutral,
      "The neutral; default: the first FILE, or in a folder the file with \"neutral\" in its name");
  command
      ->add_option("--exclude", arguments->exclude,
                   "Leave out files of these names (* and ? match), repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--threshold", arguments->options.threshold,
                   "Ignore displacements below this part of the face's box diagonal")
      ->capture_default_str();
  command->add_flag("--compress", arguments->save.compress, "Write EXT_meshopt_compression");
  command->footer("Example: mien assemble FaceXModel --exclude 'identity*' -o ict.glb");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
