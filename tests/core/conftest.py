"""The tests of the mathematics are the same on every run, and no test is about time."""

from hypothesis import settings

settings.register_profile("core", deadline=None, derandomize=True, max_examples=50)
settings.load_profile("core")
