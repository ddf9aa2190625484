"""Path-traced views by Mitsuba (an extra): ceiling off, some doors and drawers open, sky and a low sun."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL.Image import Image as PilImage

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.errors import UsageError
from pipeline.preview.denoise import Guides, denoise
from pipeline.preview.triangles import Batch, home_batches
from pipeline.rendering.normals import corner_normals
from pipeline.rendering.palette import display
from pipeline.rendering.raster import face_normals, fill

ELEVATION = math.radians(56)  # of the camera above the horizon
AZIMUTH = math.radians(-18)  # of the camera about +Z, from the front (-Y)
FIELD_OF_VIEW = 32.0  # along the image's longer side [degrees]
SKY = (0.62, 0.74, 0.95)
SUN = (-0.66, -0.26, 1.0)  # direction towards the sun, turned with the camera: from the left, a little behind
SUN_IRRADIANCE = 3.2
SUN_ANGLE = math.radians(4.0)  # radius of the sun's disc, larger than the real one for soft shadows
EXPOSURE = 0.78
FINER = 2  # the picture is traced and denoised this much finer, then averaged: smooth edges at no more rays
PAPER = 1.15  # what is behind the home: almost white after exposure


def path_trace(
    home: Home,
    assets: Mapping[str, Asset],
    path: Path,
    size: tuple[int, int] = (640, 480),
    spp: int = 25,
    open_fraction: float = 0.6,
    level: int = 0,
) -> Path:
    """Render one storey to a PNG of `size` (width, height) pixels with `spp` samples each; returns its path.

    Doors, drawers and lids stand at `open_fraction` of their range. Raises UsageError where Mitsuba is not installed.
    """
    mi = mitsuba()
    azimuth = _azimuth(home, level, size)
    batches = home_batches(home, assets, level, open_fraction, np.array([math.sin(azimuth), -math.cos(azimuth)]))
    points = np.concatenate([b.faces.reshape(-1, 3) for b in batches])
    fine = (FINER * size[0], FINER * size[1])
    camera = fit_camera(points, fine, azimuth, ELEVATION)
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 5},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": list(SKY)}},
        "sun": sun(mi, points, azimuth),
        "sensor": {
            "type": "perspective",
            "fov": FIELD_OF_VIEW,
            "fov_axis": "larger",
            "to_world": mi.ScalarTransform4f().look_at(camera.eye.tolist(), (camera.eye - camera.back).tolist(), [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": fine[0], "height": fine[1], "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent", "sample_count": max(1, round(spp / FINER**2))},
        },
    }
    for i, batch in enumerate(batches):
        scene[f"mesh_{i:03d}"] = _mesh(mi, f"mesh_{i:03d}", batch)
    image = np.asarray(mi.render(mi.load_dict(scene), seed=0), np.float32)
    guides = _guides(camera, batches)
    image = denoise(image, guides)
    save(np.where((guides.depth > 0)[..., None], image, np.float32(PAPER)), path, size)
    return path


def mitsuba() -> ModuleType:
    """Return Mitsuba with its scalar variant chosen. Raises UsageError where it is not installed."""
    try:
        import mitsuba as mi
    except ImportError as error:
        remedy = "pip install mitsuba (or the extra: pip install '.[render]')"
        raise UsageError("path-traced views need Mitsuba, which is not installed", remedy) from error
    mi.set_log_level(mi.LogLevel.Error)
    mi.set_variant("scalar_rgb")  # the llvm variants abort with some systems' LLVM, the cuda ones want a GPU
    return mi


@dataclass(frozen=True, slots=True)
class Camera:
    """A perspective camera: `right`, `up`, `back` (3,) unit; `focal` [pixels]; `size` width and height [pixels]."""

    eye: NDArray[np.float64]
    right: NDArray[np.float64]
    up: NDArray[np.float64]
    back: NDArray[np.float64]
    focal: float
    size: tuple[int, int]

    def project(self, points: NDArray[np.float64], samples: int) -> NDArray[np.float32]:
        """Map (..., 3) to u, v [pixels, `samples` per pixel] and the inverse of the distance along the view, which is linear in u, v."""
        local = points - self.eye
        away = -(local @ self.back)
        u = self.size[0] / 2 + self.focal * (local @ self.right) / away
        v = self.size[1] / 2 - self.focal * (local @ self.up) / away
        return np.stack([u * samples, v * samples, 1 / away], axis=-1).astype(np.float32)


def _azimuth(home: Home, level: int, size: tuple[int, int]) -> float:
    """Choose the side to look from: the front, or the right where a deep home would then fill the picture better."""
    corners = np.concatenate([room.polygon for room in home.plan.rooms if room.level == level])
    width, depth = np.ptp(corners, axis=0)
    return AZIMUTH + (math.pi / 2 if (depth > 1.15 * width) == (size[0] >= size[1]) and abs(depth / width - 1) > 0.15 else 0.0)


def fit_camera(points: NDArray[np.float64], size: tuple[int, int], azimuth: float, elevation: float) -> Camera:
    """Stand where all points (N, 3) are in the picture, with a small margin; angles [rad] as of AZIMUTH and ELEVATION."""
    ca, sa, ce, se = math.cos(azimuth), math.sin(azimuth), math.cos(elevation), math.sin(elevation)
    back, right = np.array([sa * ce, -ca * ce, se]), np.array([ca, sa, 0.0])
    up = np.cross(back, right)
    tangent = math.tan(math.radians(FIELD_OF_VIEW) / 2)
    half = tangent * np.array([size[0], size[1]]) / max(size) * 0.95
    target = (points.min(axis=0) + points.max(axis=0)) / 2
    distance = 10.0
    for _ in range(4):  # centring and distance depend on each other; four rounds settle below a pixel
        local = points - target
        away = local @ back
        u, v = local @ right, local @ up
        distance = float(np.max([np.abs(u) / half[0] + away, np.abs(v) / half[1] + away]))
        for axis, values in ((right, u), (up, v)):
            slopes = values / (distance - away)
            target = target + axis * distance * (slopes.max() + slopes.min()) / 2
    return Camera(target + distance * back, right, up, back, max(size) / 2 / tangent, size)


def _guides(camera: Camera, batches: list[Batch], samples: int = 2) -> Guides:
    """Rasterise what each pixel shows: its colour averaged over `samples` x `samples` points, normal and depth at its middle."""
    faces = np.concatenate([b.faces for b in batches])
    colours = np.concatenate([b.colours for b in batches])
    width, height = camera.size
    frame = fill(camera.project(faces, samples), colours, None, (samples * width, samples * height), (1.0, 1.0, 1.0))
    albedo = frame.colour.reshape(height, samples, width, samples, 3).mean(axis=(1, 3), dtype=np.float32) / 255
    middle = slice(samples // 2, None, samples)
    item, inverse = frame.item[middle, middle], frame.depth[middle, middle]
    hit = item >= 0
    normals = np.where(hit[..., None], face_normals(faces)[item], 0.0).astype(np.float32)
    depth = np.where(hit, 1 / np.maximum(inverse, 1e-6), 0.0).astype(np.float32)
    return Guides(albedo, normals, depth)


def sun(mi: ModuleType, points: NDArray[np.float64], azimuth: float) -> dict[str, Any]:
    """Place the sun as a far glowing ball; its radiance gives SUN_IRRADIANCE whatever its size."""
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    c, s = math.cos(azimuth), math.sin(azimuth)
    direction = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ SUN / np.linalg.norm(SUN)
    distance = 20 * float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    radius = distance * math.tan(SUN_ANGLE)
    radiance = SUN_IRRADIANCE / (math.pi * math.sin(SUN_ANGLE) ** 2)
    value = [radiance, 0.90 * radiance, 0.74 * radiance]
    return {
        "type": "sphere",
        "to_world": mi.ScalarTransform4f().translate((centre + distance * direction).tolist()).scale(radius),
        "emitter": {"type": "area", "radiance": {"type": "rgb", "value": value}},
    }


def _mesh(mi: ModuleType, name: str, batch: Batch) -> Any:
    """Make one mesh of all triangles of a finish, with a normal per corner and a colour per face."""
    count = len(batch.faces)
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(_surface(batch))
    mesh = mi.Mesh(name, vertex_count=3 * count, face_count=count, has_vertex_normals=True, props=properties)
    mesh.add_attribute("face_color", 3, batch.colours.ravel())
    values = mi.traverse(mesh)
    values["vertex_positions"] = batch.faces.astype(np.float32).ravel()
    values["vertex_normals"] = corner_normals(batch.faces).astype(np.float32).ravel()
    values["faces"] = np.arange(3 * count, dtype=np.uint32)
    values.update()
    return mesh


def _surface(batch: Batch) -> dict[str, Any]:
    colour = {"type": "mesh_attribute", "name": "face_color"}
    if batch.roughness >= 0.55 and batch.metallic < 0.5:
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": colour}}
    gloss = {"roughness": max(0.08, batch.roughness), "metallic": batch.metallic, "specular": 0.4}
    return {"type": "twosided", "bsdf": {"type": "principled", "base_color": colour, **gloss}}


def save(image: NDArray[np.float32], path: Path, size: tuple[int, int]) -> None:
    """Write what `tone_map` makes of an image as a PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    tone_map(image, size).save(path)


def tone_map(image: NDArray[np.float32], size: tuple[int, int]) -> PilImage:
    """Expose, compress the highlights above the middle, encode as sRGB, average down to `size`."""
    from PIL import Image

    exposed = np.maximum(image * EXPOSURE, 0.0)
    toned = np.where(exposed < 0.6, exposed, 0.6 + 0.4 * (exposed - 0.6) / (exposed - 0.6 + 0.4))
    return Image.fromarray((np.clip(display(toned), 0, 1) * 255 + 0.5).astype(np.uint8)).resize(size, Image.Resampling.BOX)
