"""Any shape into any shape by one button: match the shapes, key the path, say what came of it."""

from dataclasses import replace

import bpy

from ...core.ifs import IFSError
from ...core.matching import BUDGET, match_steps
from ...core.morph import SCHEMES
from .. import pairs
from ..conversion import core_name, flip_of, identifier, pixel, shapes_of, tolerance
from ..fcurves import rearrange_offsets
from ..property_options import window_held
from ..tasks import LongTask
from .path import key_path, keying_problem, tell
from .poll import matchable_morph

WORK = {"QUICK": BUDGET, "THOROUGH": 8 * BUDGET}
"""Budget of core's search for each that may be chosen."""


class _Match(LongTask):
    """Look for the best match, and keep the best one found so far when Esc is pressed."""

    bl_options = {"REGISTER", "UNDO"}

    best = None
    """The best match so far."""
    locked = 0
    """Pairs that it was to keep; every match begins with them."""

    @property
    def on_escape(self):
        """What Esc does, for the status bar."""
        if self.best is None:
            return "Cancel"
        return f"Keep the best so far, swell {self.best.report.most_swell:.2f}"

    def work(self, context):
        """Search, then keep what was found."""
        settings = context.object.ifs_morph
        initial, final = shapes_of(settings)
        locked = ()
        if any(item.locked for item in settings.matching.pairs):
            fitted = pairs.fitted(initial, final, settings.matching)
            if fitted is None:
                problem = pairs.problem(initial, final, settings.matching)
                raise IFSError(f"Locked pairs do not fit the maps; unlock them, or Clear Pairs. {problem}")
            locked = tuple(pair for pair, item in zip(fitted, settings.matching.pairs, strict=True) if item.locked)
            self.locked = len(locked)
        best = yield from match_steps(
            initial,
            final,
            max(2, settings.path.frame_end - settings.path.frame_start + 1),
            tolerance(settings),
            locked,
            scheme=None if _is_open(settings) else core_name(settings.scheme, SCHEMES),
            flip=flip_of(settings),
            budget=WORK[settings.matching.budget],
            found=self._found,
        )
        self._keep(context, best)

    def _found(self, match):
        self.best = match

    def interrupt(self, context):
        """Keep the best match so far, or leave everything as it was before there is one."""
        if self.best is None:
            return super().interrupt(context)
        self.cancel(context)
        try:
            self._keep(context, self.best)
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _keep(self, context, match):
        owner = context.object
        matching = owner.ifs_morph.matching
        locks = tuple(k < self.locked for k in range(len(match.pairs)))
        with window_held(owner):
            pairs.write(matching, match.pairs, locks)
            if _is_open(owner.ifs_morph):
                owner.ifs_morph.scheme = identifier(match.morph.scheme)
            report = self.keep(owner, match)
        self.say(owner.ifs_morph, report)


def _is_open(settings) -> bool:
    """Whether the scheme may be another than the one chosen."""
    return settings.matching.choose_scheme and settings.scheme != identifier("elementwise")


class IFSMORPH_OT_morph(_Match, bpy.types.Operator):
    """Pair the maps of any two shapes, find a path that stays in one piece, and key it over the frames"""

    bl_idname = "ifs_morph.morph"
    bl_label = "Morph"

    @classmethod
    def poll(cls, context):
        """Need two shapes, and F-curves that may be written."""
        if not matchable_morph(cls, context):
            return False
        problem = keying_problem(context.object)
        if problem:
            cls.poll_message_set(problem)
        return problem is None

    def keep(self, owner, match):
        """Key the path of the match; the report on what is keyed."""
        keyed = key_path(owner, match.path)
        return replace(match.report, path=replace(match.report.path, path=keyed))

    def say(self, settings, report):
        """Say what came of it, once the window is that of the new path."""
        text = report.text(pixel(settings))
        tell(settings, text)
        for line in text.splitlines()[:2]:
            self.report({"WARNING" if report.disconnected else "INFO"}, line)


class IFSMORPH_OT_match_pairs(_Match, bpy.types.Operator):
    """Pair the maps so that as little as can be breaks on the way. Keys stay, but for paths that maps have alone"""

    bl_idname = "ifs_morph.match_pairs"
    bl_label = "Match Pairs"

    poll = classmethod(matchable_morph)

    def keep(self, owner, match):
        """Leave the keys as they are, but for paths that maps had of their own: these belong to other pairs."""
        rearrange_offsets(owner, ())
        return match.report

    def say(self, settings, report):
        """Say what the pairs are."""
        self.report({"INFO"}, report.text().splitlines()[0])


CLASSES = (IFSMORPH_OT_morph, IFSMORPH_OT_match_pairs)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
