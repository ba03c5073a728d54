"""Public headers include only Eigen, mien's own public headers and the standard library; a type has its name to itself."""

import pathlib
import re
import sys
import unittest

import house

STANDARD = re.compile(r"[a-z0-9_]+")


def problem_of(bracket, include):
    if bracket == '"':
        if not include.startswith("mien/"):
            return f'"{include}" is not one of mien\'s headers'
        if house.is_private(include):
            return f"{include} is private"
        return None
    if include.startswith("Eigen/") or STANDARD.fullmatch(include):
        return None
    return f"<{include}> is neither Eigen nor of the standard library"


def problems(root):
    found = []
    for path in house.sources(root / "src/mien"):
        if path.suffix != ".h" or house.is_private(path.relative_to(root)):
            continue
        text = path.read_text(encoding="utf-8")
        if not text.startswith("#pragma once\n///"):
            found.append(f"{path.relative_to(root)}: starts with #pragma once and a /// line that says what it is for")
        for bracket, include in house.includes(path):
            problem = problem_of(bracket, include)
            if problem:
                found.append(f"{path.relative_to(root)}: {problem}")
    return found


NAMESPACE = re.compile(r"^(?:inline )?namespace\s*([\w:]*)\s*\{")
TYPE = re.compile(r"^(?:struct|class|enum class)\s+(\w+)\b(?!::)(?:\s+final)?(?:\s*:[^{;]*)?\s*\{")


def types_of(text):
    """The types that a file defines at the beginning of a line, with their namespaces; those without linkage are left out."""
    found, spaces = [], []
    for line in text.splitlines():
        space, name = NAMESPACE.match(line), TYPE.match(line)
        if space:
            spaces.append(space.group(1))
        elif line.startswith("}  // namespace"):
            spaces.pop()
        elif name and "" not in spaces:
            found.append("::".join(spaces + [name.group(1)]))
    return found


def shared_types(root):
    """Two types of one name in one namespace are one to the linker, which then mixes what templates make of them."""
    places = {}
    for path in house.sources(root / "src/mien"):
        for name in types_of(path.read_text(encoding="utf-8")):
            places.setdefault(name, []).append(str(path.relative_to(root)))
    return {name: files for name, files in places.items() if len(files) > 1}


class Rule(unittest.TestCase):
    def test_what_is_allowed(self):
        for bracket, include in (("<", "vector"), ("<", "Eigen/Core"), ('"', "mien/core/error.h")):
            self.assertIsNone(problem_of(bracket, include))

    def test_what_is_not(self):
        for bracket, include in (("<", "unistd.h"), ("<", "embree3/rtcore.h"), ("<", "nlohmann/json.hpp"),
                                 ('"', "command.h"), ('"', "mien/io/detail/json.h")):
            self.assertIsNotNone(problem_of(bracket, include))


    def test_types_and_their_namespaces(self):
        text = "namespace a::b {\nstruct One {\n};\nnamespace {\nclass Two {\n};\n}  // namespace\nclass Three;\n}  // namespace a::b\n"
        self.assertEqual(types_of(text), ["a::b::One"])


class PublicHeaders(unittest.TestCase):
    root = None

    def test_a_type_has_its_name_to_itself(self):
        self.assertEqual(shared_types(self.root), {})

    def test_public_headers_need_eigen_and_the_standard_library_alone(self):
        self.assertEqual(problems(self.root), [])


if __name__ == "__main__":
    PublicHeaders.root = pathlib.Path(sys.argv.pop(1))
    unittest.main()
