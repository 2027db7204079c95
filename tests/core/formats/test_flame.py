"""Flames in the dialects of the programs that write them, and sentences for what is no affine map."""

import numpy as np
import pytest

from core.affine import compose, transform
from core.formats import FormatError, read_shapes, read_text, write_text
from core.formats.entry import Entry

APOPHYSIS = (
    """<Flames name="flames">
<flame name="Apophysis-090129-1" version="Apophysis 2.08 beta" size="640 480" center="0 0" scale="240" angle="0" >
   <xform weight="0.5" color="0" symmetry="-0.5" linear="1" coefs="0.5 0 0 0.5 0 0" chaos="1 1 " opacity="1" />
   <xform weight="1.5" color="1" linear3D="0.5" coefs="0 1 -1 0 1 -2" post="2 0 0 2 0 0.25" opacity="1" name="a"\
var_color="0.5" />
   <palette count="256" format="RGB">
      FF0000"""
    + "00FF00" * 254
    + """0000ff
   </palette>
</flame>
</Flames>
"""
)

FLAM3 = """<test>
<flame time="0" palette="15" size="640 480" center="0 0" scale="240" hue="0.22851">
   <xform coefs="0.5 0 0 0.5 0 0" weight="0.25" color="1 0" var="1 0 0 0"/>
   <xform weight="0.75" color_speed="0.25" animate="1" var1="0" coefs='0.5 0 0 0.5 0.5 0'/>
   <color index="1" rgb="0 255 0"/><color index="0" rgb="255 127.5 0"/>
   <edit by="me" date="today"><sheep generation="1" id="2"/></edit>
</flame>
</test>
"""

FRACTORIUM = """<?xml version="1.0"?>
<flame version="EMBER-0.9.5" name="tiles">
    <xform weight="0.5" color="0" var_color="1" color_speed="0.5" animate="1" pre_linear="0.5"\
 linear="1" post_linear="2" coefs="0.5 0 0 0.5 1 0" flatten="1" opacity="1" />
    <xform weight="0.5" color="1" linear="0.5" linear3D="0.5" coefs="0.5 0 0 0.5 0 1" chaos="1 0.25" opacity="0" />
    <finalxform color="0" linear="1" coefs="2 0 0 2 1 0" opacity="1" animate="0" />
    <colors count="2" data="00FF000000000080"/>
</flame>
"""

JWILDFIRE = """<jwf-flame name="two layers">
<layer name="" weight="1.0" visible="1" density="1.0">
  <xform weight="0.5" color="0.0" mod_gamma="0.0" mod_hue_speed="0.0" material="0.0" color_type="DIFFUSION"\
 linear3D="0.5" linear3D_fx_priority="0" linear#2#="0.5" coefs="0.5 0.0 0.0 0.5 0.0 0.0" chaos="1.0 1.0"/>
  <xform weight="0.5" color="0.5" linear="1.0" coefs="0.5 0.0 0.0 0.5 1.0 0.0" yzCoefs="1.0 0.0 0.0 1.0 0.0 0.0"/>
</layer>
<layer name="hidden" visible="0"><xform weight="1" linear="1" coefs="0.5 0 0 0.5 0 0"/></layer>
<layer name="flower" visible="1"><xform weight="1" linear="1" coefs="0.25 0 0 0.5 0 0"/></layer>
</jwf-flame>
""".replace("jwf-flame", "flame")


def one(text):
    """Return the single entry of a text."""
    (entry,) = read_text(text).entries
    return entry


def flame(*xforms, more=""):
    """Return a flame of transforms given by their attributes."""
    return f'<flame name="a" {more}>' + "".join(f"<xform {xform}/>" for xform in xforms) + "</flame>"


HALF = 'weight="1" linear="1" coefs="0.5 0 0 0.5 0 0"'
MOVED = 'weight="1" linear="1" coefs="0.5 0 0 0.5 1 -2"'
TURN = 'weight="1" symmetry="1" linear="1" coefs="0 1 -1 0 0 0"'


def test_apophysis():
    found = read_text(APOPHYSIS)
    assert found.problems == ()
    (entry,) = found.entries
    assert entry.name == "Apophysis-090129-1"
    # y points down there: x' = -y + 1, y' = x - 2, halved and then doubled and moved, becomes this.
    np.testing.assert_array_equal(entry.maps[1], [[0, 1, 1], [-1, 0, 1.75]])
    np.testing.assert_array_equal(entry.weights, [0.5, 1.5])
    np.testing.assert_array_equal(entry.colors, [0, 1])
    np.testing.assert_array_equal(entry.color_speeds, [0.75, 0.5])
    assert entry.transitions is entry.opacities is None
    assert entry.palette.shape == (256, 3)
    np.testing.assert_array_equal(entry.palette[[0, 1, 255]], [[255, 0, 0], [0, 255, 0], [0, 0, 255]])


def test_flam3():
    entry = one(FLAM3)
    assert entry.name == "flame 1"
    np.testing.assert_array_equal(entry.maps, [[[0.5, 0, 0], [0, 0.5, 0]], [[0.5, 0, 0.5], [0, 0.5, 0]]])
    np.testing.assert_array_equal(entry.color_speeds, [0.5, 0.25])
    np.testing.assert_array_equal(entry.palette, [[255, 128, 0], [0, 255, 0]])


def test_fractorium():
    found = read_text(FRACTORIUM)
    (entry,) = found.entries
    assert entry.maps.shape == (2, 2, 3)
    np.testing.assert_array_equal(entry.transitions, [[1, 1], [1, 0.25]])
    np.testing.assert_array_equal(entry.opacities, [1, 0])
    np.testing.assert_array_equal(entry.palette, [[255, 0, 0], [0, 0, 128]])
    assert found.problems == ()
    np.testing.assert_array_equal(found.shapes["tiles"].transitions, [[1, 1], [1, 0.25]])
    np.testing.assert_array_equal(found.shapes["tiles"].opacity, [1, 0])


def test_final_transform_is_applied_to_the_shape():
    with_final = one(FRACTORIUM)
    without = one(FRACTORIUM.replace('<finalxform color="0"', '<finalxform enabled="0"'))
    final = np.array([[2.0, 0, 1], [0, 2, 0]])
    for whole, part in zip(with_final.maps, without.maps, strict=True):
        np.testing.assert_allclose(
            transform(whole, transform(final, [0.3, 0.7])), transform(final, transform(part, [0.3, 0.7]))
        )


def test_jwildfire():
    found = read_text(JWILDFIRE)
    assert found.problems == ()
    assert [entry.name for entry in found.entries] == ["two layers layer 1", "flower"]
    np.testing.assert_array_equal(found.entries[0].maps[0], [[0.5, 0, 0], [0, 0.5, 0]])
    assert found.entries[0].transitions is None


def test_jwildfire_has_a_root_of_its_own():
    found = read_text(JWILDFIRE.replace("flame", "jwf-flame"))
    assert [entry.name for entry in found.entries] == ["two layers layer 1", "flower"]


def test_colors_that_are_none_are_left_out():
    colors = ('index="0" rgb="1 2 3"', 'index="1" rgb="nan 0 0"', 'index="x" rgb="0 0 0"', 'rgb="0 0 0"', 'index="9"')
    entry = one(flame(HALF).replace("</", "".join(f"<color {color}/>" for color in colors) + "</"))
    np.testing.assert_array_equal(entry.palette, [[1, 2, 3]])


@pytest.mark.parametrize(
    "text",
    [
        flame(HALF, MOVED),
        f"junk <b> & {flame(HALF, MOVED)} more < junk",
        f'<?xml version="1.0"?><!-- <flame> --><a>{flame(HALF, MOVED)}</b>',
        flame(HALF, MOVED).upper().replace("COEFS", "coefs").replace("WEIGHT", "weight").replace("LINEAR", "linear"),
        flame(HALF, MOVED).replace("/>", "></xform>"),
        flame(HALF, MOVED).replace('"', "'"),
        f"<xform {HALF}/><xform {MOVED} />",
        flame(HALF, 'weight="1" var="1" coefs=" 0.5, 0 ,0  0.5\n1 -2 "'),
        flame(HALF, 'weight="1" linear="2" coefs="0.25 0 0 0.25 0.5 -1" julian="0" julian_power="2"'),
        flame(
            HALF,
            MOVED + ' flatten="1" pre_ztranslate="2" motion_frequency="0" wfield_type="NONE" unknown="a" list="1 2"',
        ),
        flame(HALF, MOVED, 'weight="0" linear="1" coefs="1 0 0 1 5 5"'),
        "\ufeff" + flame(HALF, MOVED),
    ],
)
def test_ways_to_write_the_same_maps(text):
    entry = one(text)
    np.testing.assert_array_equal(entry.maps, [[[0.5, 0, 0], [0, 0.5, 0]], [[0.5, 0, 1], [0, 0.5, 2]]])
    np.testing.assert_array_equal(entry.weights, [1, 1])


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        (flame(HALF, MOVED + ' julian="0.5" julian_power="2"'), "“a”, map 2: julian is not a linear variation"),
        (flame(HALF + ' swirl="1" sinusoidal="2"'), "“a”, map 1: swirl and sinusoidal are not linear variations"),
        (flame('weight="1" var="0 1" coefs="1 0 0 1 0 0"'), "“a”, map 1: variation 1 is not"),
        (flame('weight="1" var1="13" coefs="1 0 0 1 0 0"'), "“a”, map 1: variation 13 is not"),
        (flame(HALF + ' linear_fx_priority="-1"'), "linear ahead of or after the others"),
        (flame('weight="1" linear="1" coefs="1 0 0 1 0"'), "“a”, map 1: coefs has 5 numbers instead of 6."),
        (flame('weight="1" linear="1" coefs="1 0 0 l 0 0"'), "“a”, map 1: in coefs, “l” is not a number."),
        (flame('weight="1" linear="1" coefs="1 0 0 1e200 0 0"'), "too large"),
        (flame(HALF, 'weight="1" linear="0,5" coefs="1 0 0 1 0 0"'), "“a”, map 2: in linear, “0,5” is not a number."),
        (flame('weight="1" linear="half" coefs="1 0 0 1 0 0"'), "in linear, “half” is not a number."),
        (flame(HALF + ' pre_linear=""'), "in pre_linear, “” is not a number."),
        (flame(HALF + ' spherical="1,5"'), "in spherical, “1,5” is not a number."),
        (flame(HALF + ' spherical="-inf"'), "in spherical, “-inf” is not a number."),
        (flame(HALF.replace('weight="1"', 'weight="0,5"')), "in weight, “0,5” is not a number."),
        (flame('weight="-1" linear="1"'), "negative"),
        (flame('weight="1" linear="1" coefs="1 0 0 1 0 0 colour="1"'), "look for a quote that is missing"),
        (flame(HALF + ' yzCoefs="0 1 -1 0 0 0"'), "turns out of the plane"),
        (flame(), "“a” (line 1): the flame has no transforms."),
        ('<flame name="a"/>', "no transforms"),
        (f'<flame name="a"><xform {HALF}/>', "the next flame begins in line 1 before its </flame>"),
        (flame(HALF).replace("</", '<finalxform spherical="1" coefs="1 0 0 1 0 0"/></'), "“a”, final transform: spher"),
        (flame(HALF).replace("</", '<finalxform linear="1" coefs="1 0 1 0 0 0"/></'), "final transform: it is flat"),
        (flame(HALF).replace("</", '<finalxform linear="1" opacity="0.5"/></'), "draws two shapes at once"),
        (flame(*[HALF] * 1001), "more than 1000"),
    ],
)
def test_what_is_not_affine_is_named_and_the_others_load(broken, said):
    found = read_text(broken + flame(HALF).replace('"a"', '"good"'))
    assert list(found.shapes) == ["good"]
    assert len(found.problems) == 1
    assert said in found.problems[0]


def test_every_map_that_is_not_affine_is_named():
    found = read_text(flame(HALF + ' swirl="1"', HALF, HALF + ' bent="1"'))
    assert [problem.partition(":")[0] for problem in found.problems] == ["“a”, map 1", "“a”, map 3"]


@pytest.mark.parametrize(
    ("chaos", "used"),
    [
        (["1 1 0", "1 1 0", "1 1 0"], [0, 1]),
        (["0 1 0", "1 0 0", "1 0 1"], [0, 1, 2]),
        (["1 1 0", "0 1 0", "1 1 0"], [0, 1]),
        (["0 1 0", "0 1 0", "1 0 0"], [1]),
        (["1 0 0", "1 1 0", "0 0 0"], [0, 1]),
    ],
)
def test_maps_that_no_map_leads_to_are_left_out_and_named(chaos, used):
    """Some of them only once others have been left out."""
    found = read_text(flame(*[f'{HALF} color="{k / 2}" chaos="{row}"' for k, row in enumerate(chaos)]))
    assert list(found.shapes) == ["a"]
    np.testing.assert_array_equal(found.entries[0].colors, np.array(used) / 2)
    left_out = sorted({0, 1, 2} - set(used))
    assert len(found.problems) == len(left_out)
    for k, problem in zip(left_out, found.problems, strict=True):
        assert problem.startswith(f"“a”, map {k + 1}: chaos lets no map lead to it")


@pytest.mark.parametrize("chaos", [["0 1", "0 0"], ["1 1", "0 0"], ["0 0", "0 0"]])
def test_a_map_that_nothing_may_follow_is_named(chaos):
    found = read_text(flame(*[f'{HALF} chaos="{row}"' for row in chaos]) + flame(HALF).replace('"a"', '"good"'))
    assert list(found.shapes) == [entry.name for entry in found.entries] == ["good"]
    assert len(found.problems) == 1
    assert "“a”: no map may be applied after map" in found.problems[0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (flame(HALF, more='post_symmetry_type="POINT"'), "post symmetry"),
        (flame(HALF).replace("</", '<symmetry kind="0"/></'), "drawn by lot"),
        (flame(HALF).replace("/>", '><motion motion_frequency="1"/></xform>'), "its motion is left out"),
        (flame(HALF).replace("</", "<palette>no</palette></"), "its palette cannot be read"),
        (flame(HALF, 'weight="0" linear="1"'), "map 2: it has no weight"),
    ],
)
def test_what_a_shape_does_not_show_is_said(text, said):
    found = read_text(text)
    assert len(found.entries) == len(found.problems) == 1
    assert said in found.problems[0]


@pytest.mark.parametrize(
    ("text", "opacity"),
    [
        (flame(HALF, MOVED + ' opacity="0"'), [1, 0]),
        (flame(HALF + ' opacity="0.25"', MOVED), [0.25, 1]),
        (flame(HALF, MOVED + ' opacity="-1"'), [1, 0]),
        (flame(HALF, MOVED + ' opacity="3"'), [1, 1]),
        (flame(HALF, MOVED + ' plotmode="off"'), [1, 0]),
        (flame(HALF, MOVED + ' plotmode="ON"'), [1, 1]),
        (flame(HALF, MOVED, HALF, more='soloxform="1"'), [0, 1, 0]),
        (
            flame('weight="0" linear="1"', HALF + ' opacity="0"', MOVED).replace(
                '"0" linear', '"0" opacity="0" linear'
            ),
            [0, 1],
        ),
    ],
)
def test_maps_are_as_visible_as_in_the_flame(text, opacity):
    found = read_text(text)
    (ifs,) = found.shapes.values()
    assert ifs.opacity.tolist() == opacity
    assert not any("hidden" in problem or "opacity" in problem for problem in found.problems)


def test_a_flame_that_hides_all_its_maps_is_no_shape(tmp_path):
    path = tmp_path / "dark.flame"
    path.write_text(flame(HALF + ' opacity="0"'))
    with pytest.raises(FormatError, match="“a”: all its maps are hidden"):
        read_shapes(path)


def test_turns_show_what_is_hidden_before_them():
    """Points of a hidden map are drawn once a turn is applied to them, the turns all the way round included."""
    entry = one(flame(HALF, MOVED + ' opacity="0"').replace("</", '<symmetry kind="2"/></'))
    turned = np.sign(entry.maps[:, 0, 0]) < 0
    hidden = entry.maps[:, 0, 2] != 0
    assert (turned.sum(), hidden.sum()) == (2, 2)
    assert entry.opacities[~hidden].tolist() == [1, 1]
    # A third of all points is turned: a third of these again, and so on, where every other number of turns is none.
    assert entry.opacities[hidden & turned] == pytest.approx(1)
    assert entry.opacities[hidden & ~turned] == pytest.approx(1 / 9)
    nowhere = one(flame(HALF, MOVED + ' opacity="0"', TURN.replace("0 1 -1 0", "-1 0 0 -1") + ' opacity="0"'))
    moved = nowhere.maps[:, 0, 2] != 0
    assert not nowhere.opacities[moved].any()
    assert nowhere.opacities[~moved] == pytest.approx([8 / 9, 0])


def test_a_flame_that_breaks_off_is_not_half_read():
    text = flame(HALF) + flame(HALF, MOVED)
    for length in range(len(flame(HALF)) + 8, len(text) - 1):
        found = read_text(text[:length])
        assert len(found.entries) == 1, text[:length]
        assert found.problems or "<flame" not in text[len(flame(HALF)) : length]


def test_entities_are_not_expanded():
    """A billion laughs are read as the few letters they are written with."""
    laughs = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 10))
    text = f'<!DOCTYPE flame [<!ENTITY l0 "ha">{laughs}]>' + flame(HALF).replace('"a"', '"&l9; &amp; &lt;&#65;&gt;"')
    assert one(text).name == "&l9; & <A>"


def test_bare_ampersands_and_signs_in_names():
    assert one(flame(HALF).replace('"a"', '"this & that > <those>"')).name == "this & that > <those>"


def test_symmetry_becomes_contracting_maps():
    """Two maps in the four directions: eight that contract, where the file has turns that do not."""
    entry = one(flame(HALF, MOVED).replace("</", '<symmetry kind="4"/></'))
    assert entry.count == 8
    assert (np.linalg.norm(entry.maps[:, :, :2], 2, axis=(1, 2)) < 0.51).all()
    entry.ifs().require_attractor()
    turned = compose([[0, -1, 0], [1, 0, 0]], [[0.5, 0, 1], [0, 0.5, 2]])
    assert np.isclose(entry.maps, turned).all(axis=(1, 2)).any()
    np.testing.assert_allclose(one(flame(HALF, MOVED, TURN)).maps, entry.maps, atol=1e-15)


def test_turns_stay_where_chaos_tells_them_from_other_maps():
    entry = one(flame(HALF + ' chaos="0 1"', TURN))
    assert (entry.count, entry.transitions.tolist()) == (2, [[0, 1], [1, 1]])


def test_space_has_no_place_in_it():
    with pytest.raises(FormatError, match="lies in space"):
        write_text([Entry("a", np.full((1, 3, 4), 0.25))], ".flame")


@pytest.mark.parametrize("name", ["a\x00", "a\x0b", "\ud800", "\ufffe"])
def test_names_that_xml_cannot_hold_are_refused(name):
    with pytest.raises(FormatError, match="choose another"):
        write_text([Entry(name, np.full((1, 2, 3), 0.25))], ".flame")
