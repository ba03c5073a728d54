"""What the checks of the house share: the rooms as CMakeLists.txt draws them, and the includes of a file."""

import pathlib
import re

ROOM = re.compile(r"^\s*mien_room\(\s*(\w+)([^)]*)\)", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


class Room:
    def __init__(self, name, uses, libraries):
        self.name = name
        self.uses = uses
        self.libraries = libraries


def rooms(root):
    """{name: Room} from the mien_room(NAME USES ... LIBRARIES ...) lines of CMakeLists.txt."""
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    found = {}
    for name, arguments in ROOM.findall(text):
        lists = {"USES": [], "LIBRARIES": []}
        current = None
        for word in arguments.split():
            if word in lists:
                current = lists[word]
            else:
                current.append(word)
        found[name] = Room(name, lists["USES"], lists["LIBRARIES"])
    return found


def includes(path):
    """[(bracket, file)] of a source file, bracket being '<' or '"'."""
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def sources(folder):
    return sorted(p for p in pathlib.Path(folder).rglob("*") if p.suffix in (".h", ".cpp"))


def room_of(root, path):
    return path.relative_to(root / "src/mien").parts[0]


def is_private(include):
    """Whether 'mien/<room>/detail/...' or a path below some detail/ is meant."""
    return "detail" in pathlib.PurePosixPath(include).parts
