"""What an animator does: one file for one subject."""

from . import add, files, locus, maps, matching, output, pairs, path, shapes

MODULES = (add, shapes, files, maps, matching, pairs, locus, path, output)


def register():
    """Register the operators."""
    for module in MODULES:
        module.register()


def unregister():
    """Unregister the operators."""
    for module in reversed(MODULES):
        module.unregister()
