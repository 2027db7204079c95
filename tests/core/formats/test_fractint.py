"""Fractint's files: every layout of the same numbers reads the same, and what is broken is named with its line."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.formats import FormatError, read_text, write_text
from core.formats.entry import Entry
from core.ifs import IFS
from core.shapes import SHAPES
from core.space.ifs import SpaceIFS

FERN = """
fern {
   0    0    0   .16   0    0   .01
  .85  .04 -.04  .85   0  1.6   .85
  .2  -.26  .23  .22   0  1.6   .07
 -.15  .28  .26  .24   0   .44  .07
  }
"""

FERN_IN_SPACE = """
3dfern (3D) {
   .00  .00 0 .0 .18 .0 0  0.0 0.00 0 0.0 0 .01
   .85  .00 0 .0 .85 .1 0 -0.1 0.85 0 1.6 0 .85
   .20 -.20 0 .2 .20 .0 0  0.0 0.30 0 0.8 0 .07
  -.20  .20 0 .2 .20 .0 0  0.0 0.30 0 0.8 0 .07
}
"""


def only(text):
    """Return the single entry of a text that has nothing wrong with it."""
    found = read_text(text)
    assert found.problems == ()
    (entry,) = found.entries
    return entry


def test_fern_is_the_fern_of_the_library():
    entry = only(FERN)
    assert entry.name == "fern"
    np.testing.assert_array_equal(entry.maps, SHAPES["Barnsley fern"].maps)
    np.testing.assert_array_equal(entry.ifs().weights, SHAPES["Barnsley fern"].weights)


def test_entry_in_space():
    entry = only(FERN_IN_SPACE)
    assert (entry.name, entry.dimension) == ("3dfern", 3)
    np.testing.assert_array_equal(entry.maps[1], [[0.85, 0, 0, 0], [0, 0.85, 0.1, 1.6], [0, -0.1, 0.85, 0]])
    np.testing.assert_array_equal(entry.weights, [0.01, 0.85, 0.07, 0.07])
    (shape,) = read_text(FERN_IN_SPACE).shapes.values()
    assert isinstance(shape, SpaceIFS)
    np.testing.assert_array_equal(shape.maps, entry.maps)
    (again,) = read_text(write_text([Entry(shape.name, shape.maps, shape.weights)], ".ifs")).shapes.values()
    np.testing.assert_array_equal(again.maps, shape.maps)
    np.testing.assert_array_equal(again.weights, shape.weights)


@pytest.mark.parametrize(
    "heading", ["{3}(3D){{", "{3} (3d)\n{{", "{3}\n(3D)\n{{", "{3}\n\n{{ (3D)", "{3} ( 3D ) ; fern\n{{ ; {{\n"]
)
def test_marks_of_space(heading):
    body = FERN_IN_SPACE.partition("{")[2]
    assert only(heading.replace("{3}", "3dfern").replace("{{", "{") + body).dimension == 3


def test_probabilities_may_be_missing():
    levy = "Levy {; The Levy Dragon\n 0.5, -0.5,  0.5,  0.5,  0,  0\n 0.5,  0.5, -0.5,  0.5,  0.5,  0.5\n}"
    entry = only(levy)
    assert entry.weights is None
    np.testing.assert_array_equal(entry.maps[1], [[0.5, 0.5, 0.5], [-0.5, 0.5, 0.5]])


def test_probabilities_may_be_missing_in_space():
    body = "\n".join(line.rpartition(" ")[0] for line in FERN_IN_SPACE.strip().splitlines()[1:-1])
    entry = only(f"fern (3D) {{\n{body}\n}}")
    assert entry.weights is None
    np.testing.assert_array_equal(entry.maps, only(FERN_IN_SPACE).maps)


def test_probabilities_may_be_missing_in_some_lines():
    found = read_text("fern { 0 0 0 .16 0 0 .01\n .85 .04 -.04 .85 0 1.6\n .2 -.26 .23 .22 0 1.6 .07 }")
    (entry,) = found.entries
    assert (entry.count, entry.weights) == (3, None)
    assert "not every map has a probability" in found.problems[0]


@pytest.mark.parametrize(
    ("dimension", "count", "with_probability"), [(2, 7, range(6)), (2, 8, [3]), (3, 13, range(12)), (3, 14, [0])]
)
def test_lines_tell_where_the_count_of_numbers_misleads(dimension, count, with_probability):
    """Six probabilities among seven maps make up 48 numbers, which would be eight maps without."""
    maps = np.random.default_rng(count).uniform(-0.5, 0.5, (count, dimension * (dimension + 1))).round(3)
    lines = [" ".join(map(str, row)) + " 0.1" * (k in with_probability) for k, row in enumerate(maps)]
    found = read_text("\n".join([f"a {'(3D) ' * (dimension == 3)}{{", *lines, "}"]))
    (entry,) = found.entries
    assert (entry.count, entry.weights) == (count, None)
    np.testing.assert_array_equal(entry.maps[..., -1], maps[:, -dimension:])
    assert "not every map has a probability" in found.problems[0]


def test_probabilities_that_sum_to_one_tell_before_the_lines():
    """A program may break its lines wherever there is no room left."""
    table = np.random.default_rng(3).uniform(-0.5, 0.5, (7, 7)).round(3)
    table[:, 6] = [0.1, 0.1, 0.2, 0.2, 0.1, 0.2, 0.1]
    words = list(map(str, table.ravel()))
    lines = [" ".join(words[k : k + 6]) for k in range(0, 42, 6)]
    entry = only("a {\n" + "\n".join([*lines, " ".join(words[42:])]) + "\n}")
    np.testing.assert_array_equal(entry.weights, table[:, 6])


@pytest.mark.parametrize(("columns", "count"), [(6, 7), (7, 6), (6, 14), (7, 12)])
def test_lines_tell_where_the_count_of_numbers_does_not(columns, count):
    """42 numbers are six maps with probabilities or seven without."""
    table = np.random.default_rng(columns).uniform(-0.5, 0.5, (count, columns)).round(3)
    if columns == 7:
        table[:, 6] = 2.0  # probabilities that do not sum to one
    entry = only("a {\n" + "\n".join(" ".join(map(str, row)) for row in table) + "\n}")
    assert (entry.count, entry.weights is None) == (count, columns == 6)


def test_probabilities_tell_where_neither_lines_nor_counts_do():
    table = np.random.default_rng(1).uniform(-0.5, 0.5, (6, 7)).round(3)
    table[:, 6] = [0.17, 0.17, 0.16, 0.17, 0.17, 0.16]
    words = " ".join(map(str, table.ravel()))
    assert only(f"a {{ {words} }}").count == 6
    table[:, 6] = [17, 17, 16, 17, 15, 16]
    entry = only(f"a {{ {' '.join(map(str, table.ravel()))} }}")
    np.testing.assert_array_equal(entry.weights, table[:, 6])
    table[:, 6] = -0.25
    assert only(f"a {{ {' '.join(map(str, table.ravel()))} }}").count == 7


def test_numbers_alone_are_a_shape():
    """Fractint's first version had one shape in a file and no braces; web pages have tables of numbers."""
    body = FERN.partition("{")[2].partition("}")[0]
    found = read_text(f"; a fern\n{body}\x1a", name="leaf")
    np.testing.assert_array_equal(found.shapes["leaf"].maps, SHAPES["Barnsley fern"].maps)


def test_comment_entries_are_no_shapes():
    assert [entry.name for entry in read_text("Comment { by { nobody }\n" + FERN).entries] == ["fern"]


def test_entries_of_one_name_get_numbers():
    assert list(read_text(FERN * 3).shapes) == ["fern", "fern 2", "fern 3"]


def test_maps_that_are_never_used_are_left_out_and_named():
    found = read_text("a { .5 0 0 .5 0 0 1\n .5 0 0 .5 1 0 0 }")
    assert found.entries[0].count == 1
    assert found.problems == ("“a”, map 2: its probability is 0, so it is never drawn and is left out.",)


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ("bad {\n .5 0 0 .5 0 0 1\n .5 0 O .5 0 0 1\n}", "“bad”, line 3: “O” is not a number."),
        ("bad { .5 0 0 .5 0 0 1.5D-1 }", "“1.5D-1” is not a number"),
        ("bad { .5 0 0 .5 0 0 nan }", "“nan” is not a number"),
        ("bad { .5 0 0 .5 0 0 1_0 }", "“1_0” is not a number"),
        ("bad { .5 0 0 .5 0 0 1e999 }", "too large"),
        (
            "bad {\n .5 0 0 .5 0 0 .2\n .5 0 0 .5 0\n .5 0 0 .5 0 0 .6\n}",
            "“bad”, line 3: 5 numbers in this line; a map takes 7",
        ),
        ("bad {\n 1 2\n 3\n}", "“bad”, line 1: the entry has 3 numbers"),
        ("bad (3D) { .5 0 0 .5 0 0 1 }", "a map takes 13 (a to l and the probability)"),
        ("bad { }", "“bad”, line 1: the entry has no maps."),
        ("bad { .5 0 0 .5 0 0 -1 }", "the probability of map 1 is negative"),
        ("bad {\n .5 0 0 .5 0 0 1\n", "“bad”, line 1: the entry ends without a closing brace."),
        ("bad { " + "1 " * 7007 + "}", "more than 1000 are not read"),
    ],
)
def test_broken_entries_are_named_and_the_others_load(broken, said):
    found = read_text(broken + FERN)
    assert list(found.shapes) == ["fern"]
    assert len(found.problems) == 1
    assert said in found.problems[0]


def test_nothing_but_words():
    with pytest.raises(FormatError, match="There are no shapes"):
        read_text("once upon a time")


# ---- layouts ---------------------------------------------------------------------------------------------------------

SPACES = st.sampled_from([" ", "  ", "\t", ",", ", ", " ,\t"])
BREAKS = st.sampled_from(["\n", "\r\n", "\r", " ; a comment, with { braces } and 1 2 3\n", "\n;\n", "\r\n\r\n"])


@st.composite
def layouts(draw):
    """Draw entries, and a text that holds them in some layout."""
    entries, text = [], ""
    for k in range(draw(st.integers(1, 3))):
        dimension = draw(st.sampled_from([2, 3]))
        random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
        count = draw(st.sampled_from([1, 2, 3, 6]))
        maps = random.uniform(-1, 1, (count, dimension, dimension + 1)).round(draw(st.integers(0, 6)))
        weights = random.integers(1, 100, count)
        weights = weights / weights.sum()
        entries.append(Entry(f"shape{k}", maps, weights))
        lead = draw(BREAKS)
        text += f"{lead}{draw(st.sampled_from(['shape', 'SHAPE', 'Shape']))}{k}{draw(st.sampled_from(['', ' ', lead]))}"
        if dimension == 3:
            text += draw(st.sampled_from(["(3D)", "(3d)", " (3D) "])) + draw(st.sampled_from(["", lead]))
        text += "{" + draw(st.sampled_from(["", " ", lead]))
        for matrix, weight in zip(maps, weights, strict=True):
            for value in [*matrix[:, :dimension].ravel(), *matrix[:, dimension], weight]:
                style = draw(st.sampled_from([repr, "{:.17e}".format, "{:+.17g}".format, "{:.17E}".format]))
                text += style(float(value)).replace("0.", ".") + draw(st.one_of(SPACES, BREAKS))
        text += "}" + draw(st.sampled_from(["", lead]))
    return entries, text


@given(layouts())
def test_layout_does_not_matter(case):
    entries, text = case
    found = read_text(text)
    assert found.problems == ()
    assert len(found.entries) == len(entries)
    for read, written in zip(found.entries, entries, strict=True):
        assert read.name.casefold() == written.name
        np.testing.assert_array_equal(read.maps, written.maps)
        np.testing.assert_array_equal(read.weights, written.weights)


def test_names_with_spaces_and_odd_letters_come_back():
    names = ["two words", "Lévy", "", "a{b};c", "comment", "COMMENT", '"q"', "a\nb", "x" * 200, "two_words", "\ud800"]
    ifs = IFS([[[0.5, 0, 0], [0, 0.5, 0]]])
    text = write_text([Entry(name, ifs.maps, ifs.weights) for name in names], ".ifs")
    assert text.isascii()
    assert [entry.name for entry in read_text(text).entries] == names
    plain = [line.split()[0].casefold() for line in text.splitlines() if line.endswith("{")]
    assert len(set(plain)) == len(plain), "Fractint takes names that differ in case for one"


def test_chaos_has_no_place_in_it():
    entry = Entry("a", np.full((2, 2, 3), 0.25), transitions=np.eye(2))
    with pytest.raises(FormatError, match="chaos"):
        write_text([entry], ".ifs")


def test_opacity_has_no_place_in_it():
    entry = Entry("a", np.full((2, 2, 3), 0.25), opacities=np.array([1.0, 0.5]))
    with pytest.raises(FormatError, match=r"“a”, map 2: it has an opacity of 0.5, .* write a .flame file"):
        write_text([entry], ".ifs")
    write_text([Entry("a", np.full((2, 2, 3), 0.25), opacities=np.ones(2))], ".ifs")
