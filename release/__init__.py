"""Builds the extension's zips: ``python -m release``, or ``make package``."""
