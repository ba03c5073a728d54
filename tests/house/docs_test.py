"""The documents mirror the rooms, and their links lead somewhere."""

import pathlib
import re
import sys
import unittest

import house

LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")


def dead_links(root):
    found = []
    for path in sorted(root.glob("*.md")) + sorted((root / "docs").rglob("*.md")) + sorted(
            (root / "examples").rglob("*.md")):
        for target in LINK.findall(path.read_text(encoding="utf-8")):
            if "://" not in target and not (path.parent / target).exists():
                found.append(f"{path.relative_to(root)}: {target}")
    return found


class Docs(unittest.TestCase):
    root = None

    def test_every_room_has_a_page_that_the_index_links(self):
        index = (self.root / "docs/README.md").read_text(encoding="utf-8")
        for name in house.rooms(self.root):
            if not (self.root / "src/mien" / name).is_dir():
                continue
            with self.subTest(room=name):
                self.assertTrue((self.root / f"docs/{name}.md").is_file(), f"docs/{name}.md is missing")
                self.assertIn(f"({name}.md)", index, "docs/README.md does not link it")

    def test_every_example_explains_itself(self):
        for program in sorted((self.root / "examples").glob("*/main.cpp")):
            page = program.parent / "README.md"
            with self.subTest(example=program.parent.name):
                self.assertTrue(page.is_file(), f"{page} is missing")
                text = page.read_text(encoding="utf-8")
                for heading in ("## Description", "## Concept", "## Usage", "## Implementation"):
                    self.assertIn(heading, text)

    def test_links_lead_somewhere(self):
        self.assertEqual(dead_links(self.root), [])


if __name__ == "__main__":
    Docs.root = pathlib.Path(sys.argv.pop(1))
    unittest.main()
