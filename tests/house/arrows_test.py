"""Rooms include only what CMakeLists.txt lets them: down the arrows, never up, sideways or into a private folder."""

import pathlib
import sys
import tempfile
import unittest

import house

# Which library a bracketed include belongs to, as the LIBRARIES of mien_room name it. Eigen is free to all.
LIBRARY_OF = {
    "embree3": "embree",
    "tbb": "TBB::tbb",
    "oneapi": "TBB::tbb",
    "nlohmann": "nlohmann_json::nlohmann_json",
    "fmt": "fmt::fmt",
    "cairo": "PkgConfig::cairo",
    "meshoptimizer.h": "meshoptimizer::meshoptimizer",
    "cholmod.h": "CHOLMOD::CHOLMOD",
    "cairo.h": "PkgConfig::cairo",
    "CLI": "CLI11::CLI11",
}


def crossings(root):
    """Lines that say which file includes what it may not."""
    rooms = house.rooms(root)
    found = []
    for room in rooms.values():
        for used in room.uses:
            if used not in rooms:
                found.append(f"CMakeLists.txt: room {room.name} uses {used}, which is no room")
    found += [f"CMakeLists.txt: the arrows form a circle: {' -> '.join(circle)}" for circle in circles(rooms)]
    for path in house.sources(root / "src/mien"):
        name = house.room_of(root, path)
        place = path.relative_to(root)
        if name not in rooms:
            found.append(f"{place}: {name} is no room of CMakeLists.txt")
            continue
        for bracket, include in house.includes(path):
            problem = include_problem(rooms, rooms[name], bracket, include)
            if problem:
                found.append(f"{place}: {problem}")
    for folder in ("cli", "examples"):
        for path in house.sources(root / folder):
            for _, include in house.includes(path):
                if include.startswith("mien/") and house.is_private(include):
                    found.append(f"{path.relative_to(root)}: includes {include}, which is private to its room")
    return found


def include_problem(rooms, room, bracket, include):
    first = include.split("/")[0]
    if bracket == '"':
        if first != "mien":
            return f'includes "{include}"; quoted includes start with mien/<room>/'
        target = include.split("/")[1]
        if target not in rooms:
            return f"includes {include}, and {target} is no room"
        if target != room.name and target not in room.uses:
            return f"includes {include}; {room.name} may use {', '.join(room.uses) or 'no other room'}"
        if target != room.name and house.is_private(include):
            return f"includes {include}, which is private to {target}"
        return None
    if first == "mien":
        return f"includes <{include}>; mien's own headers are quoted"
    library = LIBRARY_OF.get(first)
    if library and library not in room.libraries:
        return f"includes <{include}>; CMakeLists.txt gives {room.name} no {library}"
    return None


def circles(rooms):
    """Every circle of arrows once, as the list of rooms along it."""
    found, done = [], set()

    def walk(name, path):
        if name in path:
            found.append(path[path.index(name):] + [name])
            return
        if name in done or name not in rooms:
            return
        for used in rooms[name].uses:
            walk(used, path + [name])
        done.add(name)

    for name in rooms:
        walk(name, [])
    return found


class PlantedViolations(unittest.TestCase):
    """The check itself is checked: each rule on a small house that breaks it."""

    def house_with(self, rooms, files):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = pathlib.Path(folder.name)
        (root / "CMakeLists.txt").write_text(rooms, encoding="utf-8")
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return root

    def expect(self, rooms, files, text):
        found = crossings(self.house_with(rooms, files))
        self.assertEqual(len(found), 1, found)
        self.assertIn(text, found[0])

    ROOMS = "mien_room(low USES LIBRARIES embree)\nmien_room(high USES low)\n"

    def test_a_sound_house_passes(self):
        files = {"src/mien/low/a.h": "#include <Eigen/Core>\n#include <vector>\n",
                 "src/mien/low/a.cpp": '#include <embree3/rtcore.h>\n#include "mien/low/detail/b.h"\n',
                 "src/mien/low/detail/b.h": "",
                 "src/mien/high/c.cpp": '#include "mien/low/a.h"\n'}
        self.assertEqual(crossings(self.house_with(self.ROOMS, files)), [])

    def test_up(self):
        self.expect(self.ROOMS, {"src/mien/low/a.cpp": '#include "mien/high/c.h"\n'}, "low may use no other room")

    def test_private(self):
        self.expect(self.ROOMS, {"src/mien/high/c.cpp": '#include "mien/low/detail/b.h"\n'}, "private to low")

    def test_private_from_the_command_line(self):
        self.expect(self.ROOMS, {"cli/x.cpp": '#include "mien/low/detail/b.h"\n'}, "private to its room")

    def test_command_line_header(self):
        self.expect(self.ROOMS, {"src/mien/high/c.cpp": '#include "command.h"\n'}, "start with mien/")

    def test_unknown_room(self):
        self.expect(self.ROOMS, {"src/mien/attic/c.cpp": ""}, "attic is no room")

    def test_library(self):
        self.expect(self.ROOMS, {"src/mien/high/c.cpp": "#include <embree3/rtcore.h>\n"}, "gives high no embree")

    def test_circle(self):
        self.expect("mien_room(a USES b)\nmien_room(b USES c)\nmien_room(c USES a)\n", {}, "circle")


class Arrows(unittest.TestCase):
    root = None

    def test_no_include_crosses_an_arrow(self):
        self.assertEqual(crossings(self.root), [])


if __name__ == "__main__":
    Arrows.root = pathlib.Path(sys.argv.pop(1))
    unittest.main()
