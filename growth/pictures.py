"""Pictures of forms, without a screen: soft sun, sky, shadow on a white ground, the polygons' edges as fine lines.

Rays go through embree (embreex). Hard solid boundaries are shown as pale bodies; containers and soft boundaries as
thin glass; a level hard plane as the ground; attractors and repellers as small balls.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, final

import numpy as np
from numpy.typing import NDArray

from genome.errors import InputError
from genome.files import write_whole
from growth.bodies import Bodies, Colour, joined, solid_body, surface_body
from growth.camera import Camera, looking_at
from growth.environment import Environment
from growth.forms import triangulate
from growth.light import TURNS, Ground, Rays, lit, sun_towards
from growth.surface import Surface

if TYPE_CHECKING:
    from PIL.Image import Image

Floats = NDArray[np.float64]

PAPER: Final[Colour] = (0.962, 0.958, 0.948)
STONE: Final[Colour] = (0.86, 0.855, 0.84)
GLASS: Final[Colour] = (0.46, 0.55, 0.63)
PULL: Final[Colour] = (0.16, 0.35, 0.56)
PUSH: Final[Colour] = (0.72, 0.16, 0.14)
FRONTS: Final[tuple[Colour, ...]] = (
    (0.81, 0.46, 0.34),
    (0.27, 0.48, 0.58),
    (0.80, 0.64, 0.28),
    (0.45, 0.52, 0.34),
    (0.55, 0.36, 0.50),
)
"""Colours of the surfaces, in turn; their backs are paler."""

LINE: Final = 0.78
SCATTERED: Final = 0.07
LINE_WIDTH: Final = 1.15
BAND: Final = 128
DEEPEST: Final = 0.1
"""How far behind a solid's surface a face that is cut by it still shows, as a share of the scene."""

MOST_BYTES: Final = 300_000


@final
@dataclass(frozen=True, slots=True, eq=False)
class _Stage:
    bodies: Bodies
    glass: Bodies
    ground: Ground
    camera: Camera
    suns: Floats
    rays: Rays
    shown: int
    shown_rays: Rays
    glass_rays: Rays
    environment: Environment | None


def render(
    surfaces: Surface | Sequence[Surface],
    environment: Environment | None = None,
    size: tuple[int, int] = (1000, 750),
    *,
    azimuth: float = -62.0,
    elevation: float = 27.0,
    samples: int = 2,
    colours: Sequence[Floats] = (),
    glass: Sequence[Surface] = (),
) -> Image:
    """Draw one or several surfaces in their environment.

    Parameters
    ----------
    surfaces
        What to draw; of several each has its own colour.
    environment
        Its boundaries and the points of its forces are drawn too.
    size
        Width and height in pixels.
    azimuth, elevation
        Where the viewer stands, in degrees; azimuth from x towards y.
    samples
        The picture is drawn this many times larger in both directions, then made smaller.
    colours
        (F, 3) sRGB from 0 to 1 of the faces of each surface; all or none are given.
    glass
        Closed surfaces that are drawn as thin glass.

    Returns
    -------
    An RGB image; the same input gives the same picture.

    Raises
    ------
    InputError
        When there is no face to draw, or a coordinate is not finite.
    """
    forms = [surfaces] if isinstance(surfaces, Surface) else list(surfaces)
    stage = _staged(_shown(forms, colours), glass, environment, size, azimuth, elevation)
    return _image(stage, samples)


def render_bodies(
    bodies: Bodies,
    size: tuple[int, int] = (1000, 750),
    *,
    azimuth: float = -62.0,
    elevation: float = 27.0,
    samples: int = 2,
    window: Floats | None = None,
) -> Image:
    """Draw triangles that have their shading and colours.

    Parameters
    ----------
    bodies
        What to draw; finite, and one triangle at least.
    size, azimuth, elevation, samples
        As of :func:`render`.
    window
        (2, 3) float64, the lowest and highest coordinates of what the camera frames, and of what stands on the ground;
        of the bodies where not given. Pictures with the same window have the same camera and ground.

    Returns
    -------
    An RGB image; the same input gives the same picture.
    """
    return _image(_staged(bodies, (), None, size, azimuth, elevation, window), samples)


def _image(stage: _Stage, samples: int) -> Image:
    from PIL import Image

    width, height = stage.camera.size
    rows = [_band(stage, top, min(top + BAND, height), samples) for top in range(0, height, BAND)]
    linear = np.concatenate(rows).reshape(height, samples, width, samples, 3).mean(axis=(1, 3))
    return Image.fromarray((255.0 * _encoded(linear) + 0.5).astype(np.uint8), "RGB")


def write_png(image: Image, path: Path) -> None:
    """Write a picture as PNG, whole or not at all; in 256 colours where it would be large.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    from PIL.Image import Dither, Quantize

    content = _png(image)
    if len(content) > MOST_BYTES:
        content = _png(image.quantize(256, method=Quantize.FASTOCTREE, dither=Dither.NONE))
    write_whole(path, content)


def _png(image: Image) -> bytes:
    stream = io.BytesIO()
    image.save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _shown(forms: Sequence[Surface], colours: Sequence[Floats]) -> Bodies:
    """Give the surfaces' triangles, each surface or face in its colour."""
    parts = []
    for index, form in enumerate(forms):
        if not np.isfinite(form.vertices).all():
            raise InputError("picture", "finite coordinates", "NaN or infinity")
        front = np.array(colours[index] if colours else FRONTS[index % len(FRONTS)])
        parts.append(surface_body(form, front, 0.55 * front + [0.4, 0.4, 0.38], LINE))
    shown = joined(parts)
    if not len(shown):
        raise InputError("picture", "a form with faces to draw", "none of three or more corners")
    return shown


def _staged(
    shown: Bodies,
    panes: Sequence[Surface],
    environment: Environment | None,
    size: tuple[int, int],
    azimuth: float,
    elevation: float,
    window: Floats | None = None,
) -> _Stage:
    places = shown.corners.reshape(-1, 3) if window is None else _box(window)
    extent = max(float(np.linalg.norm(np.ptp(places, axis=0))), 1e-9)
    solids, glass, level = _surroundings(environment, places, extent)
    glass += [solid_body(*triangulate(pane), GLASS, 0.5) for pane in panes]
    bodies = joined([shown, *solids])
    near = [places, *(part.corners.reshape(-1, 3) for part in [*solids, *glass])]
    near = [part for part in near if np.linalg.norm(np.ptp(np.concatenate([places, part]), axis=0)) < 4.0 * extent]
    camera = looking_at(np.concatenate(near), size, azimuth, elevation)
    suns = sun_towards(azimuth - 58.0, 48.0)
    rays = Rays(bodies.corners)
    if level is None:
        high_and_low = np.concatenate([places[:, 2], *(part.corners[..., 2].reshape(-1) for part in solids)])
        low, high = float(high_and_low.min()), float(high_and_low.max())
        # A flat form floats: its shadow would be thinner than the ground's tables can tell.
        level = low - max(0.003 * extent, 0.05 * extent - 0.5 * (high - low))
    glazing = joined(glass)
    return _Stage(
        bodies,
        glazing,
        Ground(rays, level, suns, size[0]),
        camera,
        suns,
        rays,
        len(shown),
        Rays(shown.corners),
        Rays(glazing.corners),
        environment,
    )


def _box(window: Floats) -> Floats:
    """Give the corners (8, 3) of the box between the lowest and highest coordinates (2, 3)."""
    which = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
    return np.take_along_axis(np.asarray(window, dtype=np.float64), which, axis=0)


def _surroundings(
    environment: Environment | None, places: Floats, extent: float
) -> tuple[list[Bodies], list[Bodies], float | None]:
    """Give the pale bodies, the glass ones, and the ground's level where a plane sets it."""
    solids: list[Bodies] = []
    glass: list[Bodies] = []
    level: float | None = None
    if environment is None:
        return solids, glass, level
    given = [*environment.settings.get("boundaries", ())]
    given.sort(key=lambda item: bool(item["soft"]))  # as the environment lists them: the hard ones first
    for item, boundary in zip(given, environment.boundaries, strict=True):
        if item.get("shape") == "plane" and item["normal"][:2] == [0.0, 0.0] and item["at"][2] <= places[:, 2].min():
            level = max(item["at"][2], -np.inf if level is None else level)
            continue
        vertices, triangles = boundary.outline(extent)
        if boundary.soft or item["solid"] == "outside" or item.get("shape") == "plane":
            glass.append(solid_body(vertices, triangles, GLASS, 0.5))
        else:
            solids.append(solid_body(vertices, triangles, STONE, 0.45))
    for name, colour in (("attractors", PULL), ("repellers", PUSH)):
        for source in environment.settings.get(name, ()):
            at = np.array(source["at"])
            if np.linalg.norm(at - places.mean(axis=0)) < 2.0 * extent:
                solids.append(_ball(at, 0.012 * extent, colour))
    return solids, glass, level


def _ball(at: Floats, radius: float, colour: Colour) -> Bodies:
    from growth.environment.boundaries._kernels import BALL
    from growth.environment.boundaries.outlines import outline_of

    vertices, triangles = outline_of(BALL, np.full(3, radius), 1.0)
    return solid_body(vertices + at, triangles, colour, 0.0)


def _band(stage: _Stage, top: int, bottom: int, samples: int) -> Floats:
    """Give the linear colours of a band of rows, (rows * samples, columns * samples, 3)."""
    width = stage.camera.size[0]
    column, row = np.arange(width * samples), np.arange(top * samples, bottom * samples)
    x, y = np.meshgrid((column + 0.5) / samples, (row + 0.5) / samples)
    spots = np.stack([x.reshape(-1), y.reshape(-1)], axis=1)
    turns = ((column[None, :] % 2) + 2 * (row[:, None] % 2)).reshape(-1) % TURNS
    ways = stage.camera.rays(spots[:, 0], spots[:, 1])
    which, distance, at = stage.rays.first(np.broadcast_to(stage.camera.eye, ways.shape), ways)
    _uncover(stage, ways, which, distance, at)
    colours = np.broadcast_to(_linear(PAPER), ways.shape).copy()
    down = np.flatnonzero((which < 0) & (ways[:, 2] < -1e-9))
    run = (stage.ground.level - stage.camera.eye[2]) / ways[down, 2]
    ahead = run > 0.0
    down, run = down[ahead], run[ahead]
    colours[down] *= stage.ground.at((stage.camera.eye + run[:, None] * ways[down])[:, :2])[:, None]
    hit = np.flatnonzero(which >= 0)
    for turn in range(TURNS):
        mine = hit[turns[hit] == turn]
        places = stage.camera.eye + distance[mine, None] * ways[mine]
        colours[mine] = _shaded(stage, which[mine], at[mine], places, spots[mine], turn)
    _glaze(stage, colours, ways, spots, distance)
    return colours.reshape(len(row), len(column), 3)


def _uncover(stage: _Stage, ways: Floats, which: NDArray[np.int32], distance: Floats, at: Floats) -> None:
    """Show, in place, the faces that a solid hides although their corners rest on it: a chord runs within a sphere.

    They are seen and lit as if they lay on the solid, where they run within it and not deep behind what hides them.
    """
    hidden = np.flatnonzero(which >= stage.shown)
    if stage.environment is None or not len(hidden):
        return
    eye = np.broadcast_to(stage.camera.eye, (len(hidden), 3))
    behind, run, spot = stage.shown_rays.first(eye, ways[hidden])
    close = (behind >= 0) & (run - distance[hidden] < DEEPEST * stage.rays.extent)
    hidden, behind, run, spot = hidden[close], behind[close], run[close], spot[close]
    within = stage.environment.inside(stage.camera.eye + run[:, None] * ways[hidden])
    over = _normals(stage.bodies, which[hidden], at[hidden])
    under = _normals(stage.bodies, behind, spot)
    turned = np.einsum("nj,nj->n", over, under) * np.einsum("nj,nj->n", ways[hidden], under) > 0.0
    taken = within & ~turned  # a turned one lies beyond the solid's horizon
    which[hidden[taken]] = behind[taken]
    at[hidden[taken]] = spot[taken]


def _normals(bodies: Bodies, which: NDArray[np.int32], at: Floats) -> Floats:
    """Give the unit shading normals at places of triangles."""
    share = np.stack([1.0 - at.sum(axis=1), at[:, 0], at[:, 1]], axis=1)
    normals = np.einsum("nk,nkj->nj", share, bodies.normals[which])
    return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12))


def _shaded(stage: _Stage, which: NDArray[np.int32], at: Floats, places: Floats, spots: Floats, turn: int) -> Floats:
    bodies = stage.bodies
    normals = _normals(bodies, which, at)
    away = np.einsum("nj,nj->n", normals, places - stage.camera.eye) > 0.0
    normals = np.where(away[:, None], -normals, normals)
    albedo = _linear(np.where(away[:, None], bodies.back[which], bodies.front[which]))
    lifted = places + 1.5e-3 * stage.rays.extent * normals
    sunny, sky = lit(stage.rays, lifted, normals, turn, stage.suns)
    facing = np.maximum(0.0, normals @ stage.suns.mean(axis=0))
    up = 0.5 + 0.5 * normals[:, 2]
    warm, cool, bounce = np.array([1.0, 0.965, 0.9]), np.array([0.93, 0.97, 1.03]), np.array([1.0, 0.98, 0.95])
    light = (0.98 * facing * sunny)[:, None] * warm
    light += (sky * (0.10 + 0.36 * up))[:, None] * cool + (sky * 0.16 * (1.0 - up))[:, None] * bounce
    # Light that has met a surface before: folds that see neither sun nor sky are dark, not black.
    light += SCATTERED * (0.7 + 0.3 * normals[:, 2])[:, None] * bounce
    ink = _lines(stage.camera, bodies, which, spots)
    return np.asarray(albedo * light * (1.0 - ink)[:, None])


def _lines(camera: Camera, bodies: Bodies, which: NDArray[np.int32], spots: Floats) -> Floats:
    """Give how dark the lines are at places of the picture: by the distance in pixels from the triangle's sides."""
    seen = camera.seen(bodies.corners[which])
    side = np.roll(seen, -1, axis=1) - seen
    out = spots[:, None, :] - seen
    twice = np.abs(side[:, 0, 0] * side[:, 1, 1] - side[:, 0, 1] * side[:, 1, 0])
    length = np.maximum(np.linalg.norm(side, axis=2), 1e-9)
    distance = np.abs(side[..., 0] * out[..., 1] - side[..., 1] * out[..., 0]) / length
    strength = np.clip(0.5 + 0.5 * LINE_WIDTH - distance, 0.0, 1.0)
    fine = np.clip(np.sqrt(twice) / 14.0, 0.12, 1.0)  # a tangle of lines would blacken small faces
    return np.asarray((strength * bodies.lines[which]).max(axis=1) * fine)


def _glaze(stage: _Stage, colours: Floats, ways: Floats, spots: Floats, distance: Floats) -> None:
    """Lay the glass bodies that stand before what is seen over the colours, the nearest two sides of them."""
    if not len(stage.glass):
        return
    origins = np.broadcast_to(stage.camera.eye, ways.shape).copy()
    gone = np.zeros(len(ways))
    live = np.arange(len(ways))
    for _ in range(2):
        which, run, at = stage.glass_rays.first(origins[live], ways[live])
        before = (which >= 0) & (gone[live] + run < distance[live])
        live, which, run, at = live[before], which[before], run[before], at[before]
        normals = _normals(stage.glass, which, at)
        slant = 1.0 - np.abs(np.einsum("nj,nj->n", normals, ways[live]))
        ink = _lines(stage.camera, stage.glass, which, spots[live])
        cover = np.maximum(0.05 + 0.22 * slant**3, 0.7 * ink)[:, None]
        colours[live] = colours[live] * (1.0 - cover) + _linear(stage.glass.front[which]) * cover
        step = run + 2e-4 * stage.glass_rays.extent
        gone[live] += step
        origins[live] += step[:, None] * ways[live]


def _linear(colour: Colour | Floats) -> Floats:
    """Turn sRGB values into amounts of light."""
    return np.asarray(np.power(np.asarray(colour, dtype=np.float64), 2.2))


def _encoded(light: Floats) -> Floats:
    """Turn amounts of light into sRGB values, the brightest rolled off gently."""
    bright = np.where(light > 0.8, 0.8 + 0.2 * np.tanh((light - 0.8) / 0.2), light)
    return np.asarray(np.power(np.clip(bright, 0.0, 1.0), 1.0 / 2.2))
