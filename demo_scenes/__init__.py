"""Scenes that show what the extension does, built by script as an animator would build them by hand.

Each scene is a module with a `TITLE` and a function `build`. `render` makes the animation, `save` the .blend files and
the stills that stand beside the scripts, and `figures` draws the figures of the paper.
"""

SCENES = ("turned_gasket_to_gasket", "terdragon_to_gasket", "fern_to_leaf", "tree_to_flowsnake")
