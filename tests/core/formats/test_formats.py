"""Both formats: what is written reads back equal to the bit, and whatever is read gives shapes or a sentence."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.formats import FormatError, read_file, read_shapes, read_text, write_file, write_shapes, write_text
from core.formats.entry import Entry, with_unique_names
from core.formats.symmetry import symmetry_maps, unfold
from core.ifs import IFS, IFSError
from core.shapes import SHAPES
from tests.core.formats.test_flame import APOPHYSIS, FLAM3, FRACTORIUM, JWILDFIRE
from tests.core.formats.test_fractint import FERN, FERN_IN_SPACE

both = pytest.mark.parametrize("suffix", [".ifs", ".flame"])

NUMBERS = st.floats(-1e100, 1e100, allow_nan=False)
SHARES = st.floats(0, 1, exclude_min=True)
NAMES = st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\ufffe\uffff"), max_size=30)


def arrays(shape, elements):
    """Draw arrays of a shape."""
    return st.lists(elements, min_size=int(np.prod(shape)), max_size=int(np.prod(shape))).map(
        lambda values: np.array(values, dtype=float).reshape(shape)
    )


@st.composite
def entries(draw, suffix):
    """Draw entries with all that a format has a place for."""
    drawn = []
    for name in draw(st.lists(NAMES, min_size=1, max_size=3, unique=True)):
        count = draw(st.integers(1, 4))
        weights = draw(arrays((count,), st.floats(1e-100, 1e100)))
        if suffix == ".ifs":
            dimension = draw(st.sampled_from([2, 3]))
            maps = draw(arrays((count, dimension, dimension + 1), NUMBERS))
            drawn.append(Entry(name, maps, weights / weights.sum()))
        else:
            maps = draw(arrays((count, 2, 3), NUMBERS))
            transitions = draw(st.none() | arrays((count, count), st.floats(0, 1e100)))
            opacities = draw(st.none() | arrays((count,), st.floats(0, 1)))
            if opacities is not None and (opacities == 1).all():
                opacities = None
            if transitions is not None:
                # Each map is used: it may come after itself.
                transitions = np.maximum(transitions, np.eye(count))
            if transitions is not None and (transitions == 1).all():
                transitions = None
            colors, speeds = draw(arrays((count,), NUMBERS)), draw(arrays((count,), SHARES))
            palette = draw(st.integers(1, 256).flatmap(lambda size: st.binary(min_size=3 * size, max_size=3 * size)))
            palette = np.frombuffer(palette, np.uint8).reshape(-1, 3)
            drawn.append(Entry(name, maps, weights, transitions, colors, speeds, opacities, palette))
    return drawn


def assert_equal_to_the_bit(read, written):
    for name in ("maps", "weights", "transitions", "colors", "color_speeds", "opacities", "palette"):
        one, other = getattr(read, name), getattr(written, name)
        assert (one is None) == (other is None), name
        if one is not None:
            assert (one.shape, one.dtype, one.tobytes()) == (other.shape, other.dtype, other.tobytes()), name


@both
@given(data=st.data())
def test_what_is_written_reads_back_equal(suffix, data):
    written = data.draw(entries(suffix))
    found = read_text(write_text(written, suffix))
    assert [entry.name for entry in found.entries] == [
        entry.name or _unnamed(suffix, k) for k, entry in enumerate(written)
    ]
    for read, other in zip(found.entries, written, strict=True):
        assert_equal_to_the_bit(read, other)


def _unnamed(suffix, k):
    """A flame without a name is called by its number; in an .ifs file even no name is kept."""
    return f"flame {k + 1}" if suffix == ".flame" else ""


@both
def test_library_reads_back_equal(tmp_path, suffix):
    path = tmp_path / f"library{suffix}"
    write_shapes(path, SHAPES)
    shapes = read_shapes(path)
    assert list(shapes) == list(SHAPES)
    for name, ifs in SHAPES.items():
        assert shapes[name].name == name
        assert shapes[name].maps.tobytes() == ifs.maps.tobytes()
        assert shapes[name].weights.tobytes() == ifs.weights.tobytes()
    written = path.read_bytes()
    write_shapes(path, shapes)
    assert path.read_bytes() == written


@given(weights=st.lists(st.floats(1e-6, 1e6), min_size=1, max_size=40))
def test_weights_are_scaled_once(weights):
    ifs = IFS(np.full((len(weights), 2, 3), 0.25), weights)
    assert IFS(ifs.maps, ifs.weights).weights.tobytes() == ifs.weights.tobytes()


@both
@pytest.mark.parametrize(
    ("maps", "weights", "said"),
    [
        (np.full((2, 2, 3), np.nan), None, "NaN"),
        (np.full((2, 2, 3), 1e200), None, "beyond 1e\\+100"),
        (np.full((2, 2, 3), 0.5), np.array([1.0, 0.0]), "map 2: the weight is 0"),
        (np.full((2, 2, 3), 0.5), np.array([1.0]), "give each a weight"),
        (np.full((2, 4), 0.5), None, "shape"),
        (np.full((1001, 2, 3), 0.5), None, "at most 1000"),
    ],
)
def test_what_would_not_read_back_is_not_written(tmp_path, suffix, maps, weights, said):
    path = tmp_path / f"a{suffix}"
    path.write_text("before")
    with pytest.raises(FormatError, match=said):
        write_file(path, [Entry("good", np.full((1, 2, 3), 0.5)), Entry("bad", maps, weights)])
    assert path.read_text() == "before"


# ---- files -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
@pytest.mark.parametrize("text", [FERN.replace("fern", "fougère"), FLAM3.replace("time=", 'name="fougère" time=')])
def test_encodings(tmp_path, encoding, text):
    path = tmp_path / "a.txt"
    path.write_bytes(text.encode(encoding))
    assert list(read_shapes(path)) == ["fougère"]


@pytest.mark.parametrize("suffix", [".ifs", ".flame", ".flam3", ".xml", ""])
@pytest.mark.parametrize("text", [FERN, FLAM3])
def test_contents_say_the_format_whatever_the_suffix(tmp_path, suffix, text):
    path = tmp_path / f"a{suffix}"
    path.write_text(text)
    assert len(read_file(path).shapes) == 1


def test_numbers_alone_are_named_after_their_file(tmp_path):
    path = tmp_path / "half.ifs"
    path.write_text(".5 0 0 .5 0 0 1\n")
    assert list(read_shapes(path)) == ["half"]


def test_files_that_cannot_be_read(tmp_path):
    for path, said in (
        (tmp_path / "none.ifs", "“none.ifs” cannot be read"),
        (tmp_path, "cannot be read"),
        ("a\x00.ifs", "cannot be read"),
    ):
        with pytest.raises(FormatError, match=said):
            read_file(path)
    (tmp_path / "empty.ifs").write_bytes(b"")
    with pytest.raises(FormatError, match="There is no text"):
        read_file(tmp_path / "empty.ifs")


@pytest.mark.parametrize("comment", ["; converted from a <flame> file\n{}", "{}; no <xform>\r", "{}"])
def test_comments_that_speak_of_flames(comment):
    text = FERN.replace("{", "{ ; was a <flame>") if comment == "{}" else comment.format(FERN)
    assert list(read_text(text).shapes) == ["fern"]


def test_entities_before_a_flame_in_one_line():
    assert list(read_text('<a b="&amp;">' + FLAM3.replace("\n", " ")).shapes) == ["flame 1"]


PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 8


@pytest.mark.parametrize(
    "contents",
    [
        b"<flames></flames>",
        b'<?xml version="1.0"?><foo a="1"/>',
        b"<!DOCTYPE html><style>p { margin: 0 }</style><script>if (1) { a = [1, 2]; }</script><p>1 2 3",
        b'{"name": "fern", "maps": [[0.85, 0.04, 1.6], [-0.04, 0.85, 0.0]]}',
        b"x,y\n1.0,a\n2.0,b",
        b"{}",
        PNG,
    ],
)
def test_files_of_other_kinds_have_no_shapes(tmp_path, contents):
    path = tmp_path / "other.ifs"
    path.write_bytes(contents)
    with pytest.raises(FormatError, match=r"“other.ifs”: There are no shapes: neither .* Fractint .* nor flames"):
        read_file(path)


@both
def test_entries_of_one_name_take_no_longer_than_others(suffix):
    """Numbers are not looked for from the start each time."""
    tried = []

    class Name(str):
        def __format__(self, form):
            tried.append(self)
            return str(self)

    entry = Entry(Name("a"), np.full((1, 2, 3), 0.25))
    named = with_unique_names([entry, replace(entry, name="a 3"), *[entry] * 500, replace(entry, name="a 2")])
    assert [each.name for each in named][:5] == ["a", "a 3", "a 2", "a 4", "a 5"]
    assert [each.name for each in named][-2:] == ["a 502", "a 2 2"]
    assert len(tried) <= 501
    text = write_text([replace(entry, name="a")], suffix)
    assert [each.name for each in read_text(text * 3).entries] == ["a", "a 2", "a 3"]


def test_shapes_of_a_file_without_any_say_why(tmp_path):
    path = tmp_path / "a.flame"
    path.write_text(FRACTORIUM.replace('linear="1"', 'swirl="1"'))
    with pytest.raises(FormatError, match="map 1: swirl is not"):
        read_shapes(path)
    path.write_text(FRACTORIUM.replace('chaos="1 0.25"', 'chaos="0 0"'))
    with pytest.raises(FormatError, match="no map may be applied after map 2"):
        read_shapes(path)


def test_files_that_cannot_be_written(tmp_path):
    shapes = {"a": SHAPES["gasket"]}
    for path, said in ((tmp_path / "a.txt", "“.txt” is no format"), (tmp_path / "no" / "a.ifs", "cannot be written")):
        with pytest.raises(FormatError, match=said):
            write_shapes(path, shapes)
    with pytest.raises(FormatError, match="no shapes"):
        write_shapes(tmp_path / "a.ifs", {})


# ---- whatever comes --------------------------------------------------------------------------------------------------

SAMPLES = [FERN, FERN_IN_SPACE, APOPHYSIS.replace("00FF00" * 254, ""), FLAM3, FRACTORIUM, JWILDFIRE]
WORDS = (
    "<flame |<xform |</flame>|<finalxform |<symmetry kind='|<layer>|\"|'|/>|>|coefs=|weight=|linear=|var1=|chaos=|"
    "1e308 |-1 |0 |NaN|{|}|;|(3D)|\n|<!--|-->|99999999999999|1e99 1e99 1e99 1e99 1 1|&#0;|&#x110000;|\x1a|\x00|é"
)
PIECES = st.sampled_from(WORDS.split("|"))


@st.composite
def mangled(draw):
    """Draw a real file with a piece cut out, put in or moved about."""
    text = draw(st.sampled_from(SAMPLES))
    for _ in range(draw(st.integers(1, 4))):
        first, second = sorted(draw(st.lists(st.integers(0, len(text)), min_size=2, max_size=2)))
        second = draw(st.sampled_from([first, second, min(first + 1, len(text))]))
        text = text[:first] + draw(st.sampled_from(["", text[second : second + 40]]) | PIECES) + text[second:]
    return text


def read_or_refused(text):
    """Read a text that may be anything; all of it that is read must be usable."""
    try:
        found = read_text(text)
    except FormatError as error:
        assert str(error)
        assert isinstance(error, IFSError)
        return
    assert found.entries or found.problems
    assert all(problem.endswith(".") for problem in found.problems), found.problems
    for entry in found.entries:
        assert np.isfinite(entry.maps).all()
        assert entry.weights is None or (entry.weights > 0).all()
    for ifs in found.shapes.values():
        assert np.isfinite(ifs.weights).all()


@given(st.text() | st.lists(PIECES, max_size=40).map("".join) | mangled())
def test_any_text_gives_shapes_or_a_sentence(text):
    read_or_refused(text)


@pytest.mark.parametrize(
    "text",
    [
        "{" * 200_000,
        "a {" * 100_000,
        "<flame" * 100_000,
        '<a "' * 100_000,
        "<!--" * 100_000,
        "<xform " + "a" * 400_000 + "!>",
        "<xform" + "a" * 400_000,
        "<" + " " * 400_000 + "xform<flame>",
        "<xform " + "a='" * 100_001 + ">",
        "<flame><xform " + "".join(f'a_{k}="1" ' for k in range(50_000)) + "/></flame>",
        "<flame>" + "<xform/>" * 50_000 + "</flame>",
        "(" + " " * 400_000,
        "1 " * 200_000,
    ],
    ids=range(13),
)
def test_large_nonsense_takes_no_longer_than_its_length(text):
    """Each of these would take hours if time grew with the square of the length."""
    read_or_refused(text)


@given(st.binary(max_size=400))
def test_any_bytes_give_shapes_or_a_sentence(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "any.ifs"
    path.write_bytes(data)
    try:
        read_file(path)
    except FormatError as error:
        assert "any.ifs" in str(error)


@pytest.mark.parametrize("sample", SAMPLES)
def test_files_cut_short(sample):
    for length in range(0, len(sample), 3):
        read_or_refused(sample[:length])


# ---- symmetry --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "size"), [(2, 2), (3, 3), (12, 12), (-1, 2), (-2, 4), (-5, 10)])
def test_groups_of_symmetries(kind, size):
    maps = symmetry_maps(kind)
    frequencies = np.full(len(maps), 0.5 / len(maps))
    group, shares, _ = unfold(maps, frequencies, np.ones(len(maps)))
    assert len(group) == size
    assert np.isclose(shares.sum(), 2), "the mean number of turns after a map is that of a geometric law"
    # The measure of a chain of random turns, by walking along it.
    walked, share = np.zeros(size), np.eye(size)[0]
    step = np.array(
        [
            [sum(f for m, f in zip(maps, frequencies, strict=True) if np.allclose(m @ b, a)) for b in group]
            for a in group
        ]
    )
    for _ in range(60):
        walked, share = walked + share, step @ share
    np.testing.assert_allclose(shares, walked, rtol=1e-12)


def test_groups_that_are_too_large():
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    assert unfold(turn[None], np.array([0.5]), np.ones(1)) is None


def test_opacities_are_written_and_read_back_equal(tmp_path):
    path = tmp_path / "veiled.flame"
    square = IFS(SHAPES["square"].maps, opacity=[0, 0.1, 1, 1 / 3])
    write_shapes(path, {"square": square, "gasket": SHAPES["gasket"]})
    read = read_shapes(path)
    assert read["square"].opacity.tobytes() == square.opacity.tobytes()
    assert read["gasket"].drawn.all()
    assert path.read_text().count("opacity") == 4


def test_recurrent_shapes_are_written_and_read_back_equal(tmp_path):
    path = tmp_path / "chaos.flame"
    square = IFS(SHAPES["square"].maps, [0.1, 0.2, 0.3, 0.4], transitions=1.5 * (1 - np.eye(4)))
    write_shapes(path, {"square": square})
    (read,) = read_shapes(path).values()
    for name in ("maps", "weights", "transitions"):
        assert getattr(read, name).tobytes() == getattr(square, name).tobytes()


def test_chaos_that_leaves_no_map_to_follow_is_a_sentence(tmp_path):
    path = tmp_path / "chaos.flame"
    transitions = [[1.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]
    write_file(path, [Entry("stuck", SHAPES["gasket"].maps, np.ones(3), np.array(transitions))])
    with pytest.raises(FormatError, match="no map may be applied after map 3"):
        read_shapes(path)
