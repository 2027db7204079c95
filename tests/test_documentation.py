"""What the documentation points to is there, and its pictures are small."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = ("README.md", "docs/guide.md")
LARGEST = 150 * 1024
"""Of a picture of the guide, in bytes."""


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_to_files(page):
    path = ROOT / page
    text = path.read_text(encoding="utf-8")
    links = re.findall(r'\]\(([^)#:]+)\)|src="([^"]+)"', text)
    assert links
    for target in {first or second for first, second in links}:
        assert (path.parent / target).exists(), f"{page} points to {target}"


def test_pictures_of_the_guide_are_small_and_shown():
    pages = "".join((ROOT / page).read_text(encoding="utf-8") for page in PAGES)
    for picture in (ROOT / "docs").glob("*.png"):
        assert picture.name in pages
        assert picture.stat().st_size < LARGEST
