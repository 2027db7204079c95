"""The sidebar tabs, the Add menu and the File menu."""

from . import files, lists, locus_sidebar, menus, pairs, panels, presets

MODULES = (lists, pairs, menus, presets, panels, locus_sidebar, files)


def register():
    """Register lists, menus, presets and panels."""
    for module in MODULES:
        module.register()


def unregister():
    """Unregister them in reverse order."""
    for module in reversed(MODULES):
        module.unregister()
