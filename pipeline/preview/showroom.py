"""A model by itself on a neutral floor, path-traced by Mitsuba (an extra) with its textures: what contact sheets are made of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from io import BytesIO
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from pipeline.entities.asset import Asset, Material, Mesh
from pipeline.geometry.kinematics import link_transforms
from pipeline.preview.denoise import Guides, denoise
from pipeline.preview.trace import FIELD_OF_VIEW, FINER, fit_camera, mitsuba, sun, tone_map
from pipeline.rendering.normals import corner_normals
from pipeline.rendering.pose import open_joint_values

AZIMUTH = math.radians(28)  # of the camera from the front (-Y) towards +X
ELEVATION = math.radians(19)
SKY = (0.80, 0.86, 0.95)
FLOOR = (0.58, 0.57, 0.55)
WALL = (0.64, 0.63, 0.61)
FAR = 400.0  # how far the floor reaches, in heights of the model


def portrait(asset: Asset, pixels: int = 240, spp: int = 24, open_fraction: float = 0.0, *, on_wall: bool = False) -> Image.Image:
    """Render an asset to a square picture of `pixels` a side; its doors and drawers stand at `open_fraction` of their range.

    With `on_wall` it hangs before a wall. Raises UsageError where Mitsuba is not installed.
    """
    mi = mitsuba()
    values = open_joint_values(asset, open_fraction)
    transforms = link_transforms(asset, np.array([values.get(j.name, 0.0) for j in asset.joints]))
    placed = [
        (mesh, mesh.vertices @ T[:3, :3].T + T[:3, 3]) for link, T in zip(asset.links, transforms, strict=True) for mesh in link.visuals
    ]
    points = np.concatenate([v for _, v in placed])
    fine = FINER * pixels
    camera = fit_camera(points, (fine, fine), AZIMUTH, ELEVATION)
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "aov", "aovs": "albedo:albedo,normal:sh_normal,depth:depth", "image": {"type": "path", "max_depth": 5}},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": list(SKY)}},
        "sun": sun(mi, points, math.radians(-12)),
        "ground": _plane(mi, points, on_wall=on_wall),
        "sensor": {
            "type": "perspective",
            "fov": FIELD_OF_VIEW,
            "to_world": mi.ScalarTransform4f().look_at(
                origin=camera.eye.tolist(), target=(camera.eye - camera.back).tolist(), up=[0, 0, 1]
            ),
            "film": {"type": "hdrfilm", "width": fine, "height": fine, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent", "sample_count": max(1, round(spp / FINER**2))},
        },
    }
    surfaces = {k: mi.load_dict(_surface(mi, m, asset.textures)) for k, m in enumerate(asset.materials)}
    for i, (mesh, vertices) in enumerate(placed):
        scene[f"mesh_{i:03d}"] = _shape(mi, f"mesh_{i:03d}", mesh, vertices, surfaces[mesh.material])
    image = np.asarray(mi.render(mi.load_dict(scene), seed=0), np.float32)
    guides = Guides(np.maximum(image[..., 3:6], 0.02), image[..., 6:9], image[..., 9])
    return tone_map(denoise(image[..., :3], guides), (pixels, pixels))


def _plane(mi: ModuleType, points: NDArray[np.float64], *, on_wall: bool) -> dict[str, Any]:
    """Return the floor below the points, or the wall behind them."""
    low, high = points.min(axis=0), points.max(axis=0)
    T = mi.ScalarTransform4f()
    reach = FAR * float((high - low).max())
    if on_wall:
        to_world = T.translate([0, float(high[1]) + 0.001, 0]).rotate([1, 0, 0], 90).scale(reach)
    else:
        to_world = T.translate([0, 0, float(low[2]) - 0.0005]).scale(reach)
    color = {"type": "rgb", "value": list(WALL if on_wall else FLOOR)}
    return {"type": "rectangle", "to_world": to_world, "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color}}}


def _shape(mi: ModuleType, name: str, mesh: Mesh, vertices: NDArray[np.float64], surface: Any) -> Any:
    """Make one mesh with a normal and texture coordinates per corner."""
    faces = vertices[mesh.faces]
    properties = mi.Properties()
    properties["bsdf"] = surface
    count = len(faces)
    shape = mi.Mesh(name, vertex_count=3 * count, face_count=count, has_vertex_normals=True, has_vertex_texcoords=True, props=properties)
    uv = np.zeros((3 * count, 2)) if mesh.uv is None else mesh.uv[mesh.faces].reshape(-1, 2) * [1, -1] + [0, 1]
    values = mi.traverse(shape)
    values["vertex_positions"] = faces.astype(np.float32).ravel()
    values["vertex_normals"] = corner_normals(faces).astype(np.float32).ravel()
    values["vertex_texcoords"] = uv.astype(np.float32).ravel()
    values["faces"] = np.arange(3 * count, dtype=np.uint32)
    values.update()
    return shape


def _surface(mi: ModuleType, material: Material, textures: Mapping[str, bytes]) -> dict[str, Any]:
    """Return the scattering of a material: diffuse where rough, else glossy; what one sees through is thin."""
    color: dict[str, Any] = {"type": "rgb", "value": list(material.base_color)}
    if material.texture is not None and material.texture in textures:
        picture = np.array(Image.open(BytesIO(textures[material.texture])).convert("RGB"))
        color = {"type": "bitmap", "bitmap": mi.Bitmap(picture), "filter_type": "bilinear"}
    if material.roughness >= 0.7 and material.metallic < 0.5:
        base: dict[str, Any] = {"type": "diffuse", "reflectance": color}
    else:
        rough = max(0.12, material.roughness)
        base = {"type": "principled", "base_color": color, "roughness": rough, "metallic": material.metallic, "specular": 0.4}
    whole = {"type": "twosided", "bsdf": base}
    return whole if material.opacity >= 1 else {"type": "mask", "opacity": material.opacity, "bsdf": whole}
