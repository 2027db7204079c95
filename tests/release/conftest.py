"""Builds each zip once for all tests of this folder."""

from functools import cache

import pytest

from release.zips import build


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """Build the zip of a platform when a test first asks for it."""
    output = tmp_path_factory.mktemp("packages")
    return cache(lambda platform: build(platform, output))
