"""Assets of a dataset in the form that SimReady's profiles ask for, with what must not be in a dataset's own bytes: an author and a date.

    python examples/simready_assets.py DATASET --out DIR --author "A. Person" [--assets ASSET_ID ...]

Each lies as OUT/<asset_id>/usd/<asset_id>.usda, the one USD file of its folder (rule NP.005), its payload in payloads/ beside it, what MuJoCo
reads as runnables/physics/mujoco.usda (RV.008). The interface says the date (SR.001); a JSON file of the same name holds the fields of
provenance that the asset itself does not (SR.004). Without ids all assets whose item of
Wikidata is known. `simready-validate --profile Robotics-Prop --version 4.0.0 OUT/<asset_id>/usd/<asset_id>.usda` looks at one.
"""

import argparse
import datetime as dt
import json
import shutil
from pathlib import Path

from pxr import Sdf, Usd, UsdPhysics, UsdUtils

ITEMS = {"cabinet": "Q14745", "stool": "Q14745", "appliance": "Q212920"}  # furniture, home appliance; others have a label of their own
ASIDE = (".thumbs", "runnables")  # folders that stay beside the interface
RUNTIME = "runnables/physics"


def main() -> None:
    """Write the assets that are asked for."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("dataset", type=Path)
    options.add_argument("--assets", nargs="*", default=[])
    options.add_argument("--out", type=Path, required=True)
    options.add_argument("--author", required=True)
    given = options.parse_args()
    library = given.dataset / "assets"
    for name in given.assets or sorted(p.name for p in library.iterdir() if p.is_dir()):
        path = package(library / name, given.out, given.author, dt.datetime.now(tz=dt.UTC).date())
        print(path or f"{name}: no item of Wikidata is known for it")


def package(asset: Path, out: Path, author: str, day: dt.date) -> Path | None:
    """Write the folder of an asset below `out` and return its interface; None where no item of Wikidata is known."""
    interface = Sdf.Layer.FindOrOpen(str(asset / f"{asset.name}.usda"))
    item = wikidata_item(interface)
    if not item:
        return None
    folder = out / asset.name / "usd"
    shutil.copytree(asset, folder / "payloads", dirs_exist_ok=True, ignore=lambda place, _: ASIDE if Path(place) == asset else ())
    for name in ASIDE:
        if (asset / name).is_dir():
            shutil.copytree(asset / name, folder / name, dirs_exist_ok=True)
    (folder / "payloads" / f"{asset.name}.usda").unlink()
    moved = Sdf.Layer.CreateAnonymous(".usda")
    moved.TransferContent(interface)
    moved.customLayerData = {**moved.customLayerData, "usd_date_generated": day.isoformat()}
    make_body(moved)
    own = f"{RUNTIME}/{asset.name}_mujoco.usda"  # in a dataset named after its asset: packed together, files of one name would be one
    if (folder / own).is_file():
        (folder / own).rename(folder / RUNTIME / "mujoco.usda")
    UsdUtils.ModifyAssetPaths(
        moved, lambda path: f"./{RUNTIME}/mujoco.usda" if path == f"./{own}" else f"./payloads/{path.removeprefix('./')}"
    )
    path = folder / f"{asset.name}.usda"
    moved.Export(str(path))
    path.with_suffix(".json").write_text(json.dumps({"author": author, "qcode": item}, indent=1))
    return path


def make_body(interface: Sdf.Layer) -> None:
    """Make furniture that stands still, which has colliders and no body in a dataset, one body that can be pushed (RB.001)."""
    about = interface.customLayerData["SimReady_Metadata"]
    if not about["rigid_body_count"]:
        stage = Usd.Stage.Open(interface, Usd.Stage.LoadNone)
        UsdPhysics.RigidBodyAPI.Apply(stage.GetDefaultPrim())
        UsdPhysics.MassAPI.Apply(stage.GetDefaultPrim()).CreateMassAttr(about["mass"])
        interface.customLayerData = {**interface.customLayerData, "SimReady_Metadata": {**about, "rigid_body_count": 1}}


def wikidata_item(interface: Sdf.Layer) -> str:
    """Return the item of Wikidata that an asset is one of, its own label's before its kind's; "" where none is known."""
    label = interface.GetPrimAtPath(f"/{interface.defaultPrim}").attributes.get("semantics:labels:wikidata_qcode")
    kind = interface.customLayerData["SimReady_Metadata"]["super_category"]
    return str(label.default[0]) if label else ITEMS.get(kind, "")


if __name__ == "__main__":
    main()
