"""Homes in other formats than USD: MJCF, URDF, GLB, all written from one reading of the USD stages.

`stage` reads what lies on disk through USD's schemas into the records of `model`; `mjcf`, `urdf` and `glb` write those.
"""

from pipeline.export.folder import FORMATS, ExportFolder, export_home, home_stages

__all__ = ["FORMATS", "ExportFolder", "export_home", "home_stages"]
