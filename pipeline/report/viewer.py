"""A page that shows a GLB in three dimensions: trimesh's viewer (three.js, inlined) around the file's own bytes."""

import base64
import io
import zipfile

import trimesh
from trimesh import resources

from pipeline.errors import ContentError

FOV, NEAR, FAR = 40, 0.05, 500.0  # [degrees], [m], [m]
AMBIENT, HEADLIGHT = 0.5, 0.7  # shares of light: from everywhere, from the eye
# The viewer takes the file's first camera, which a home has not, and shows colours as if they were linear; ceilings would hide all else.
REPLACED = {
    "camera=gltf.cameras[0];": f"camera=new THREE.PerspectiveCamera({FOV},innerWidth/innerHeight,{NEAR},{FAR});",
    "centerControls(scene,camera,controls);render()": """
const box=new THREE.Box3().setFromObject(gltf.scene),middle=box.getCenter(new THREE.Vector3()),far=box.getSize(new THREE.Vector3()).length();
controls.target.copy(middle);camera.position.set(middle.x,middle.y+.95*far,middle.z+.6*far);controls.update();render()""",
    "scene.add(gltf.scene);": rf"""
gltf.scene.traverse(o=>{{if(/^ceiling(_\d+)?$/.test(o.name))o.visible=false;}});scene.add(gltf.scene);
renderer.outputEncoding=THREE.sRGBEncoding;scene.add(new THREE.AmbientLight(0xffffff,{AMBIENT}));tracklight.intensity={HEADLIGHT};""",
}
TITLE = "trimesh: threejs viewer"


def viewer_page(title: str, glb: bytes) -> str:
    """Return HTML that holds the GLB and shows it without its ceilings, to be turned with the mouse; it fetches nothing.

    Raises ContentError where the installed trimesh has another viewer than the one that this changes.
    """
    page = zipfile.ZipFile(io.BytesIO(resources.get_bytes("templates/viewer.zip"))).read("viewer.html.template").decode()
    for old, new in {**REPLACED, TITLE: title, "$B64GLTF": base64.b64encode(glb).decode()}.items():
        if page.count(old) != 1:
            raise ContentError(f"the viewer of trimesh {trimesh.__version__} has another text than {old!r}", "pip install trimesh==5.2.0")
        page = page.replace(old, new)
    return page
