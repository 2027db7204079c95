"""Builds the zip of every platform and the one without wheels, checks them, and prints what is in them."""

import sys

from . import contents, zips
from .wheels import PLATFORMS


def main() -> None:
    """Build, check and list every zip; end with an error if one holds what it should not."""
    packages = {platform: zips.build(platform) for platform in (*PLATFORMS, None)}
    problems = []
    print(f"{zips.OUTPUT.relative_to(zips.ROOT)}/{'':<23}{'MB':>7}  wheels")
    for platform, package in packages.items():
        wheels = [name.rsplit("-", 2)[0] for name in contents.wheels(package)]
        print(f"{package.name:<36}{package.stat().st_size / 1e6:>7.1f}  {', '.join(wheels) or 'none'}")
        problems += [f"{package.name}: {problem}" for problem in contents.problems(package, platform)]
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main()
