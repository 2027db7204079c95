"""Rendered frames to an animation and a contact sheet, and the locus with the path on it."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from PIL import Image, ImageDraw

mpl.use("Agg")
import matplotlib.pyplot as plt

CONTACTS = 12
CONTACT_COLUMNS = 4
CONTACT_SIZE = 240


def animate(frames: list[Path], target: Path, fps: int) -> None:
    """Join frames to an animated picture that browsers play."""
    pictures = [Image.open(frame).convert("RGB") for frame in frames]
    pictures[0].save(
        target, save_all=True, append_images=pictures[1:], duration=round(1000 / fps), loop=0, quality=80, method=2
    )


def contact_sheet(frames: list[Path], path: np.ndarray, target: Path) -> None:
    """Put a dozen frames side by side, each with its place on the path (F, 3)."""
    chosen = np.unique(np.linspace(0, len(frames) - 1, min(CONTACTS, len(frames))).round().astype(int))
    rows = -(-len(chosen) // CONTACT_COLUMNS)
    sheet = Image.new("RGB", (CONTACT_COLUMNS * CONTACT_SIZE, rows * (CONTACT_SIZE + 20)))
    draw = ImageDraw.Draw(sheet)
    for place, index in enumerate(chosen):
        x, y = place % CONTACT_COLUMNS * CONTACT_SIZE, place // CONTACT_COLUMNS * (CONTACT_SIZE + 20)
        picture = Image.open(frames[index]).convert("RGB")
        sheet.paste(picture.resize((CONTACT_SIZE, CONTACT_SIZE), Image.Resampling.LANCZOS), (x, y))
        u, v, swell = path[index]
        label = f"{index + 1}: ({u:.2f}, {v:.2f})" + (f" swell {swell:.2f}" if swell > 0 else "")
        draw.text((x + 6, y + CONTACT_SIZE + 4), label, fill=(200, 200, 200))
    sheet.save(target)


def draw_locus(image, path: np.ndarray, keys: np.ndarray, output: Path) -> None:
    """Draw the picture of a locus that the extension keeps, with the path (F, 3) and its keys (K, 3) on it."""
    width, height = image.size
    pixels = np.empty(4 * width * height, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    (u, v), spacing = image.ifs_morph_locus.lowest, image.ifs_morph_locus.spacing
    extent = (u - spacing / 2, u + (width - 0.5) * spacing, v - spacing / 2, v + (height - 0.5) * spacing)
    figure, axes = plt.subplots(figsize=(7, 7), layout="constrained")
    plot_path(axes, pixels.reshape(height, width, 4), extent, path, keys)
    figure.savefig(output / "locus.png", dpi=120)
    plt.close(figure)


def plot_path(axes, picture: np.ndarray, extent: tuple, path: np.ndarray, keys: np.ndarray) -> None:
    """Plot a locus, the path over it, and the two ends, on axes of matplotlib's."""
    axes.imshow(picture, origin="lower", extent=extent, interpolation="nearest")
    axes.plot(path[:, 0], path[:, 1], color="#e8501e", linewidth=2.5)
    axes.plot(keys[:, 0], keys[:, 1], "o", color="#e8501e", markersize=5)
    axes.plot([0, 1], [0, 1], "o", markersize=10, markerfacecolor="none", markeredgecolor="#e8501e", markeredgewidth=2)
    axes.annotate("initial", (0, 0), (8, -14), textcoords="offset points", color="#c03a10")
    axes.annotate("final", (1, 1), (8, 8), textcoords="offset points", color="#c03a10")
    axes.set(xlabel="u", ylabel="v")
