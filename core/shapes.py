"""The library of named shapes: the attractors an animator can start from, each built from its geometry.

Points of the plane are complex numbers here, since a similarity is then one product and one sum. Every
shape has a function of its own, which says where the shape comes from and how its maps follow. `SHAPES`
lists them in the order of the menu.
"""

from itertools import pairwise

import numpy as np

from .ifs import IFS

GOLDEN_RATIO = (1 + 5**0.5) / 2
SQUARE_ROOT_3 = 3**0.5


def turn(degrees: float) -> complex:
    """Return the unit complex number that turns the plane counter-clockwise by an angle in degrees."""
    return complex(np.exp(1j * np.radians(degrees)))


def similarity(multiplier: complex, offset: complex, reflects: bool = False) -> np.ndarray:
    """Return the map z -> multiplier z + offset, with the conjugate of z instead of z if it reflects.

    Returns
    -------
    ndarray, shape (2, 3)
        ``[[a, b, e], [c, d, f]]``. The multiplier's modulus is the scale and its argument the angle.
    """
    x, y = multiplier.real, multiplier.imag
    if reflects:
        return np.array([[x, y, offset.real], [y, -x, offset.imag]])
    return np.array([[x, -y, offset.real], [y, x, offset.imag]])


def towards(multiplier: complex, fixed_point: complex) -> np.ndarray:
    """Return the similarity with a given multiplier that leaves one point where it is, shape (2, 3)."""
    return similarity(multiplier, fixed_point * (1 - multiplier))


def chain(steps, backwards=()) -> list[np.ndarray]:
    """Return the maps of the curve that a polygonal path generates, one similarity per edge.

    Parameters
    ----------
    steps : sequence of complex
        The edges of the path, one after the other. The path is turned and scaled so that it runs from 0 to 1,
        and each map takes it to one of its edges.
    backwards : collection of int
        The edges that the curve runs through from their end to their start.
    """
    vertices = np.concatenate([[0], np.cumsum(steps)]) / np.sum(steps)
    maps = []
    for index, (start, end) in enumerate(pairwise(vertices)):
        image_of_0, image_of_1 = (end, start) if index in backwards else (start, end)
        maps.append(similarity(image_of_1 - image_of_0, image_of_0))
    return maps


def cells(side: int, occupied) -> list[np.ndarray]:
    """Return the maps from the unit square to (column, row) cells of its side x side grid, row 0 lowest."""
    return [similarity(1 / side, complex(column, row) / side) for column, row in occupied]


def circle(count: int, first_angle: float) -> list[complex]:
    """Return evenly spaced points of the unit circle, counter-clockwise from an angle in degrees."""
    return [turn(first_angle + 360 * k / count) for k in range(count)]


TRIANGLE = (0, 1, 0.5 + SQUARE_ROOT_3 / 2 * 1j)


def gasket() -> IFS:
    """Return Sierpinski's gasket: an equilateral triangle as three halves of itself, lower left first.

    Source: Sierpinski 1915, Sur une courbe dont tout point est un point de ramification.
    """
    return IFS([towards(1 / 2, vertex) for vertex in TRIANGLE], name="gasket")


def turned_gasket() -> IFS:
    """Return Sierpinski's gasket with its lower left map turned by 180 degrees.

    The turn is about the centre of the bounding box of the gasket's own lower left attractorlet, the triangle
    (0, 0), (1/2, 0), (1/4, sqrt(3)/4): z/2 becomes 2 center - z/2.

    Source: Burch & Hart 1997, the initial shape of Figures 3 and 4.
    """
    center = 1 / 4 + SQUARE_ROOT_3 / 8 * 1j
    lower_left = similarity(-1 / 2, 2 * center)
    return IFS([lower_left, *(towards(1 / 2, vertex) for vertex in TRIANGLE[1:])], name="turned gasket")


def gasket_relative() -> IFS:
    """Return a relative of the right-angled gasket: its lower right quarter turned right, its upper left turned left.

    Turned about the centres of their quarters of the unit square, both take the origin to the centre of the square.

    Source: direct construction, after the family in Peitgen, Jürgens & Saupe 1992, Chaos and Fractals, pages 244-251.
    """
    middle = (1 + 1j) / 2
    return IFS([similarity(1 / 2, 0), similarity(-1j / 2, middle), similarity(1j / 2, middle)], name="gasket relative")


def pentigasket() -> IFS:
    """Return five small pentagons in the corners of a pentagon, each touching its neighbours at a vertex.

    Along a side of length 1, two neighbours of scale r have an edge each on the side and meet with an edge
    each at 72 degrees to it: 2 r + 2 r cos 72 = 1, so r = 1/(1 + golden ratio) = (3 - sqrt 5)/2.

    Source: the pentagons of Dürer 1525, Underweysung der Messung; maps derived above.
    """
    return IFS([towards(1 / (1 + GOLDEN_RATIO), vertex) for vertex in circle(5, 90)], name="pentigasket")


def hexagasket() -> IFS:
    """Return six hexagons of one third in the corners of a hexagon, each touching its neighbours at a vertex.

    Source: direct construction, like the pentigasket: 2 r + 2 r cos 60 = 1, so r = 1/3.
    """
    return IFS([towards(1 / 3, vertex) for vertex in circle(6, 90)], name="hexagasket")


def square() -> IFS:
    """Return the unit square as its four quarters, the lower row first.

    Source: direct construction.
    """
    return IFS(cells(2, [(0, 0), (1, 0), (0, 1), (1, 1)]), name="square")


def sierpinski_carpet() -> IFS:
    """Return Sierpinski's carpet: the unit square as its ninths without the one in the middle.

    Source: Sierpinski 1916, Sur une courbe cantorienne qui contient une image biunivoque et continue de toute
    courbe donnée.
    """
    ring = [(column, row) for row in range(3) for column in range(3) if (column, row) != (1, 1)]
    return IFS(cells(3, ring), name="Sierpinski carpet")


def vicsek_cross() -> IFS:
    """Return Vicsek's cross of five crosses, the one in the middle first.

    Source: Vicsek 1983, Fractal models for diffusion controlled aggregation.
    """
    return IFS(cells(3, [(1, 1), (2, 1), (1, 2), (0, 1), (1, 0)]), name="Vicsek cross")


def cantor_dust() -> IFS:
    """Return the product of two middle-third Cantor sets, the only shape here that is not in one piece.

    Source: the set of Cantor 1883; called dust in Mandelbrot 1982, The Fractal Geometry of Nature.
    """
    return IFS(cells(3, [(0, 0), (2, 0), (0, 2), (2, 2)]), name="Cantor dust")


def koch_curve() -> IFS:
    """Return von Koch's curve from (0, 0) to (1, 0): two sides of a triangle in place of the middle third.

    Source: von Koch 1904, Sur une courbe continue sans tangente, obtenue par une construction géométrique
    élémentaire.
    """
    return IFS(chain([1, turn(60), turn(-60), 1]), name="Koch curve")


def koch_snowflake() -> IFS:
    """Return the whole snowflake, inside and all, as a turned snowflake in the middle and six at the tips.

    The tips lie on the unit circle, and the six maps of one third there are the hexagasket's. The inner
    corners lie at radius 1/sqrt 3, where a snowflake of that scale turned by 30 degrees has its tips: it
    fills the hexagasket's hole, and the areas 1/3 + 6/9 add up to 1.

    Source: direct construction on the closed curve of von Koch 1904.
    """
    middle = similarity(turn(30) / SQUARE_ROOT_3, 0)
    return IFS([middle, *(towards(1 / 3, tip) for tip in circle(6, 90))], name="Koch snowflake")


def levy_curve() -> IFS:
    """Return Lévy's C curve from (0, 0) to (1, 0): an edge becomes the legs of a right isosceles triangle.

    Source: Lévy 1938, Les courbes planes ou gauches et les surfaces composées de parties semblables au tout.
    """
    return IFS(chain([1 + 1j, 1 - 1j]), name="Lévy curve")


def heighway_dragon() -> IFS:
    """Return Heighway's dragon from (0, 0) to (1, 0): Lévy's two edges, the second one run through backwards.

    Source: Heighway's curve of folded paper, in Davis & Knuth 1970, Number representations and dragon curves.
    """
    return IFS(chain([1 + 1j, 1 - 1j], backwards={1}), name="Heighway dragon")


def twindragon() -> IFS:
    """Return the twindragon, two Heighway dragons back to back: both maps turn and shrink by (1 + i)/2.

    The offsets 0 and (1 - i)/2 put its centre at 1/2, halfway between the common ends 0 and 1 of the two
    dragons.

    Source: Davis & Knuth 1970, Number representations and dragon curves.
    """
    multiplier = (1 + 1j) / 2
    return IFS([similarity(multiplier, 0), similarity(multiplier, multiplier.conjugate())], name="twindragon")


def terdragon() -> IFS:
    """Return the terdragon from (0, 0) to (1, 0): three edges, turning by 120 degrees left and then right.

    Source: Davis & Knuth 1970, Number representations and dragon curves.
    """
    return IFS(chain([turn(-30), turn(90), turn(-30)]), name="terdragon")


def gosper_flowsnake() -> IFS:
    """Return Gosper's flowsnake from (0, 0) to (1, 0), a curve that fills a tile made of seven tiles.

    The seven edges lie in the triangular lattice and end at a distance of sqrt 7. Three are run through
    backwards.

    Source: Gosper's curve, in Gardner 1976, Mathematical Games, Scientific American 235(6).
    """
    steps = [turn(angle) for angle in (0, -60, 180, -120, 0, 0, 60)]
    return IFS(chain(steps, backwards={1, 2, 6}), name="Gosper flowsnake")


def rauzy_fractal() -> IFS:
    """Return Rauzy's fractal: all sums of powers of the complex Tribonacci number, no three powers in a row.

    Let a be that number, a root of x^3 = x^2 + x + 1 with |a| < 1. Such a sum starts without 1, with 1 but
    not a, or with 1 + a but not a^2, and goes on freely: the maps are a z, a^2 z + 1 and a^3 z + 1 + a.
    Their areas add up to 1. The three roots sum and multiply to 1, and one is real, which gives the other
    two.

    Source: Rauzy 1982, Nombres algébriques et substitutions; maps derived above.
    """
    real_root = (1 + np.cbrt(19 + 3 * 33**0.5) + np.cbrt(19 - 3 * 33**0.5)) / 3
    real_part = (1 - real_root) / 2
    a = complex(real_part, (1 / real_root - real_part**2) ** 0.5)
    return IFS([similarity(a, 0), similarity(a**2, 1), similarity(a**3, 1 + a)], name="Rauzy fractal")


def pentigree() -> IFS:
    """Return McWorter's pentigree from (0, 0) to (1, 0): six edges, 36 or 108 degrees up or down.

    The path ends at a distance of 4 cos 36 + 2 cos 108 edges, that is 1 + golden ratio.

    Source: McWorter & Tazelaar 1987, Creating Fractals, Byte 12; also Edgar 1990, Measure, Topology, and
    Fractal Geometry.
    """
    return IFS(chain([turn(angle) for angle in (36, 108, -36, -108, -36, 36)]), name="pentigree")


def spiral() -> IFS:
    """Return a spiral beset with spirals, from (0, 0) to (1, 0).

    Heighway's dragon with the corner of its path moved from (1 + i)/2 to 0.93 at 20 degrees: the first map
    turns a little and hardly shrinks, so that its powers wind up into the origin.

    Source: direct construction.
    """
    corner = 0.93 * turn(20)
    return IFS(chain([corner, 1 - corner], backwards={1}), name="spiral")


def hata_tree() -> IFS:
    """Return Hata's tree-like set, standing on its root at the origin; both maps reflect.

    Hata's maps are c z* and (1 - |c|^2) z* + |c|^2, where z* is the conjugate of z and |c| < 1. They take c
    and 0 to the same point |c|^2, which joins the limb to the crown. Here they are turned by 90 degrees.

    Source: Hata 1985, On the structure of self-similar sets.
    """
    c = 1 / 2 + SQUARE_ROOT_3 / 6 * 1j
    joint = abs(c) ** 2
    limb = similarity(-c, 0, reflects=True)
    crown = similarity(joint - 1, 1j * joint, reflects=True)
    return IFS([limb, crown], name="Hata tree")


def barnsley_tree() -> IFS:
    """Return a tree: a flat trunk, two limbs at 45 degrees and a small copy in the fork.

    Source: Barnsley 1988, Fractals Everywhere, Table III.4, with its probabilities.
    """
    fork = 0.2j
    trunk = [[0, 0, 0], [0, 0.5, 0]]
    limbs = [similarity(0.42 + 0.42j, fork), similarity(0.42 - 0.42j, fork)]
    small_copy = similarity(0.1, fork)
    return IFS([trunk, *limbs, small_copy], weights=[0.05, 0.4, 0.4, 0.15], name="Barnsley tree")


def pythagoras_tree() -> IFS:
    """Return the symmetric tree of Pythagoras, with slender trunks in place of its squares.

    From a trunk of height 1 rise two limbs, scaled by 1/sqrt 2 and turned by 45 degrees to either side. Two
    such maps have Lévy's curve for an attractor, whatever their offsets; here it is the crown, twice as
    large as from 0 to 1, with its ends at -1 + i and 1 + i. It spans [-2, 2] and reaches up to 3 i. So a
    trunk map of height 1/3 ends in the fork at i, where both limbs begin; with a width of 1/16 the trunk is
    a quarter wide.

    Source: Bosman's tree of 1942; maps derived above.
    """
    fork = 1j
    trunk = [[1 / 16, 0, 0], [0, 1 / 3, 0]]
    limbs = [similarity((1 + 1j) / 2, fork), similarity((1 - 1j) / 2, fork)]
    return IFS([trunk, *limbs], name="Pythagoras tree")


def barnsley_fern() -> IFS:
    """Return the black spleenwort fern: the stem, the frond above it, its left and its right leaflet.

    Source: Barnsley 1988, Fractals Everywhere, Table III.3, with its probabilities.
    """
    stem = [[0, 0, 0], [0, 0.16, 0]]
    frond = [[0.85, 0.04, 0], [-0.04, 0.85, 1.6]]
    left = [[0.2, -0.26, 0], [0.23, 0.22, 1.6]]
    right = [[-0.15, 0.28, 0], [0.26, 0.24, 0.44]]
    return IFS([stem, frond, left, right], weights=[0.01, 0.85, 0.07, 0.07], name="Barnsley fern")


def maple_leaf() -> IFS:
    """Return a maple leaf: the stalk, the right and the left lobe, the tip.

    Source: a table with probabilities that goes from one IFS program to the next; who made it is not known
    to us.
    """
    stalk = [[0.14, 0.01, -0.08], [0, 0.51, -1.31]]
    right = [[0.43, 0.52, 1.49], [-0.45, 0.5, -0.75]]
    left = [[0.45, -0.49, -1.62], [0.47, 0.47, -0.74]]
    tip = [[0.49, 0, 0.02], [0, 0.51, 1.62]]
    return IFS([stalk, right, left, tip], weights=[0.1, 0.35, 0.35, 0.2], name="maple leaf")


SHAPES = {
    shape.name: shape
    for shape in (
        gasket(),
        turned_gasket(),
        gasket_relative(),
        pentigasket(),
        hexagasket(),
        square(),
        sierpinski_carpet(),
        vicsek_cross(),
        cantor_dust(),
        koch_curve(),
        koch_snowflake(),
        levy_curve(),
        heighway_dragon(),
        twindragon(),
        terdragon(),
        gosper_flowsnake(),
        rauzy_fractal(),
        pentigree(),
        spiral(),
        hata_tree(),
        barnsley_tree(),
        pythagoras_tree(),
        barnsley_fern(),
        maple_leaf(),
    )
}
