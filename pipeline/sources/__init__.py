"""Readers of other people's data: 3D-FRONT houses, 3D-FUTURE models, PartNet-Mobility / GAPartNet objects.

They turn files into rows and assets in our frames, trust nothing that they read, and give a reason for everything
that they leave out or repair (docs/reasons.md).
"""
