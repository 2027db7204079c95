"""When an operator can work on the active object; greyed-out buttons show the reason otherwise."""

from ..conversion import match_problem, shape_problem


def is_changeable(owner) -> bool:
    """Whether Blender lets an object be edited: not one in a library, nor an override that was not made for it."""
    return owner.library is None and not (owner.override_library and owner.override_library.is_system_override)


def any_morph(cls, context) -> bool:
    """Whether the active object is a morph, were it a linked one."""
    owner = context.object
    if owner is None or owner.ifs_morph.kind == "NONE":
        cls.poll_message_set("Select an IFS Morph object, or add one with Add > IFS Morph")
        return False
    return True


def editable_morph(cls, context) -> bool:
    """Whether the active object is a morph that may be changed."""
    if not any_morph(cls, context):
        return False
    if not is_changeable(context.object):
        cls.poll_message_set("The object is linked from a library; make it local or an editable library override first")
        return False
    return True


def sound_morph(cls, context) -> bool:
    """Whether the active object is a morph that may be changed and whose shapes fit each other."""
    if not editable_morph(cls, context):
        return False
    problem = shape_problem(context.object.ifs_morph)
    if problem:
        cls.poll_message_set(problem)
    return not problem


def matchable_morph(cls, context) -> bool:
    """Whether the active object is a morph that may be changed and whose shapes can be matched."""
    if not editable_morph(cls, context):
        return False
    problem = match_problem(context.object.ifs_morph)
    if problem:
        cls.poll_message_set(problem)
    return not problem


def shape_of(operator, context):
    """Return the shape that an operator's `end` names."""
    settings = context.object.ifs_morph
    return settings.initial if operator.end == "INITIAL" else settings.final


ENDS = (
    ("INITIAL", "Initial", "The shape at the start of the morph"),
    ("FINAL", "Final", "The shape at the end of the morph"),
)
