"""Colours and textures of COLLADA files: material, effect, sampler, surface, image, each of which names the next."""

import math
from collections.abc import Mapping
from typing import Any
from urllib.parse import unquote

from pipeline.sources.meshes.obj_file import MtlMaterial

Elements = Mapping[str, Any]  # of a file, by id
SHADERS = ("phong", "lambert", "blinn", "constant")


def material(name: str, elements: Elements) -> MtlMaterial:
    """Return the material of that id; what it does not say, or says wrong, is as in a material that says nothing."""
    plain = MtlMaterial(name)
    effect = _following(elements.get(name), "instance_effect", elements)
    profile = effect.find("profile_COMMON") if effect is not None else None
    shader = next((s for tag in SHADERS if profile is not None and (s := profile.find(f"technique/{tag}")) is not None), None)
    if shader is None:
        return plain
    color = _color(shader.find("diffuse")) or (*plain.diffuse, 1.0)
    texture = shader.find("diffuse/texture")
    path = _image(texture.get("texture", ""), profile, elements) if texture is not None else ""
    shininess = _number(shader.findtext("shininess/float"), plain.shininess)
    return MtlMaterial(name, color[:3], _opacity(shader), max(shininess, 0.0), map=path)


def _following(element: Any, tag: str, elements: Elements) -> Any:
    """Return what the first `tag` in an element names by its url, or None."""
    reference = element.find(tag) if element is not None else None
    return None if reference is None else elements.get(reference.get("url", "").removeprefix("#"))


def _image(sampler: str, profile: Any, elements: Elements) -> str:
    """Return the path of a texture, "" where it leads nowhere.

    COLLADA 1.4: sampler2D/source names a surface, its init_from an image; 1.5: sampler2D/instance_image. Some files name
    the image at once.
    """
    params = {p.get("sid"): p for p in profile.iter("newparam")}
    name = sampler
    for tag in ("sampler2D/source", "surface/init_from"):
        text = params[name].findtext(tag) if name in params else None
        name = text.strip() if text else name
    image = _following(params[name].find("sampler2D"), "instance_image", elements) if name in params else elements.get(name)
    if image is None or image.tag != "image":
        return ""
    path = image.findtext("init_from/ref") or image.findtext("init_from") or ""
    return unquote(path.strip())


def _opacity(shader: Any) -> float:
    """Return the opacity: COLLADA's default, A_ONE, multiplies the colour's alpha; RGB_ZERO is transparent where it is white."""
    transparent = shader.find("transparent")
    amount = _number(shader.findtext("transparency/float"), 1.0)
    color = _color(transparent) if transparent is not None else None
    if color is None:
        return 1.0
    if transparent.get("opaque", "A_ONE") == "RGB_ZERO":
        return min(max(1.0 - amount * sum(color[:3]) / 3, 0.0), 1.0)
    # Exporters that mean opaque write alpha 0 or amount 0 as often as 1: nothing is made of glass that cannot be seen.
    return min(amount * color[3], 1.0) if amount * color[3] > 0 else 1.0


def _color(element: Any) -> tuple[float, float, float, float] | None:
    """Return the colour (r, g, b, a) in an element, each within [0, 1], or None."""
    words = (element.findtext("color") or "").split() if element is not None else []
    values = [_number(word, math.nan) for word in words]
    if len(values) not in {3, 4} or not all(map(math.isfinite, values)):
        return None
    r, g, b, a = (min(max(v, 0.0), 1.0) for v in (*values, 1.0)[:4])
    return r, g, b, a


def _number(text: str | None, otherwise: float) -> float:
    try:
        value = float(text or "")
    except ValueError:
        return otherwise
    return value if math.isfinite(value) else otherwise
