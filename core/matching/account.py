"""What a match did and what it cost, in numbers and in plain words."""

from __future__ import annotations

from dataclasses import dataclass

from ..connectedness import Connectedness
from ..report import FrameCheck, PathReport
from .pairs import Pair
from .wording import symmetry_text, word_text


@dataclass(frozen=True, eq=False)
class MatchReport:
    """A path's report, with what the matching did for it and what had been without.

    Attributes
    ----------
    path : PathReport
        Of the matched morph; its `straight` is the straight line through it without swell.
    straight_polar, element_wise : FrameCheck
        Map k to map k, the shorter list again from its first, straight and without swell: by polar decomposition, and
        entry by entry. A first answer does not wait for the latter; it is None there.
    straight_swell : (float, float) or None
        Greatest and mean swell that would mend the former; None in a first answer as well.
    naive_flips : int
        Maps of both that reflect at one end only.
    pairs : tuple of Pair
    counts : (int, int)
        Maps of the two shapes as given.
    parts : int
        Maps that the morph has beyond the pairs, where the shapes allow different transitions (see `joining`).
    work : int
        Shapes decided in the search.
    """

    path: PathReport
    straight_polar: FrameCheck
    element_wise: FrameCheck | None
    straight_swell: tuple[float, float] | None
    naive_flips: int
    pairs: tuple[Pair, ...]
    counts: tuple[int, int]
    parts: int
    work: int

    @property
    def most_swell(self) -> float:
        """The greatest swell of a frame."""
        return self.path.path.most_swell

    @property
    def mean_swell(self) -> float:
        """The mean swell over the frames."""
        return self.path.path.mean_swell

    @property
    def disconnected(self) -> int:
        """Frames that are not known to be in one piece."""
        return len(self.path.path.state) - self.path.path.count(Connectedness.CONNECTED)

    @property
    def broken(self) -> int:
        """Frames that should have been in one piece: all but those between ends that are in pieces themselves."""
        return self.path.broken

    @property
    def spotless(self) -> bool:
        """Whether no frame is broken, and none swells."""
        return self.most_swell == 0 and self.broken == 0

    @property
    def worst_gap(self) -> float:
        """The widest gap, relative to the enclosing diameter."""
        return self.path.path.worst_gap

    @property
    def flips(self) -> tuple[int, ...]:
        """Pairs whose map reflects at one end only, whether it is flattened or turns over."""
        return self.path.flips + self.path.turned_over

    def text(self, pixel: float | None = None) -> str:
        """The report in a few plain sentences, a line each; `pixel` as for `FrameCheck.gap_text`."""
        names = [f"{word_text(pair.initial)} to {word_text(pair.final)}" for pair in self.pairs]
        lines = [self._pairing(), *self.path.text(pixel, names).split("\n")]
        if self.disconnected:
            worst = self.worst_gap / self.path.path.tolerance
            lines.append(f"The widest gap is {worst:.1f} times what counts as none.")
        flips = f", {self.naive_flips} map{'s' * (self.naive_flips > 1)} flipped" if self.naive_flips else ""
        for name, check in (("element by element", self.element_wise), ("by polar decomposition", self.straight_polar)):
            if check is None:
                continue
            broken = len(check.state) - check.count(Connectedness.CONNECTED)
            lines.append(
                f"Map by map in the order given, straight, {name}: {broken} of {len(check.state)} frames not in one "
                f"piece, {check.gap_text(pixel)}{flips}."
            )
        if self.straight_swell is not None and self.straight_swell[0] > 0:
            most, mean = self.straight_swell
            lines.append(f"To mend the latter takes swell: {most:.2f} at most, {mean:.3f} on average.")
        lines.append(self._certainty())
        return "\n".join(lines)

    def _pairing(self) -> str:
        parts = []
        for end, count, name in (("initial", self.counts[0], "initial"), ("final", self.counts[1], "final")):
            words = [getattr(pair, end) for pair in self.pairs]
            split = len({word[0] for word in words if len(word) > 1})
            doubled = len(words) - len(set(words))
            turned = sum(bool(symmetry_text(getattr(pair, f"{end}_symmetry"))) for pair in self.pairs)
            done = [f"{split} split"] * bool(split) + [f"{doubled} listed again"] * bool(doubled)
            done += [f"{turned} turned or mirrored by symmetries of the shape"] * bool(turned)
            parts.append(f"{count} {name} maps" + (f" ({', '.join(done)})" if done else ""))
        more = f", in {len(self.pairs) + self.parts} parts, for they allow different transitions" * bool(self.parts)
        return f"{len(self.pairs)} pairs of {parts[0]} and {parts[1]}{more}."

    def _certainty(self) -> str:
        if not self.disconnected:
            pixels = round(1 / self.path.path.tolerance)
            return f"Every frame was checked: no gap is wider than 1/{pixels} of the shape's size."
        return "Frames said to be in pieces are so for certain; those undecided may or may not be."
