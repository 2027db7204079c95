"""Sentences in panels."""

import textwrap

CHARACTER_WIDTH = 6.2
"""Mean width of a letter in the interface font at scale 1, in pixels, for breaking sentences into lines."""


def sentence(layout, context, text: str, icon: str = "NONE") -> None:
    """Draw a sentence in as many lines as the sidebar needs."""
    width = context.region.width / (CHARACTER_WIDTH * context.preferences.system.ui_scale) - 8
    column = layout.column(align=True)
    for k, line in enumerate(textwrap.wrap(text, max(16, int(width)))):
        blank = "BLANK1" if icon != "NONE" else "NONE"
        column.label(text=line, icon=blank if k else icon)
