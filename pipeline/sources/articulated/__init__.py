"""PartNet-Mobility, GAPartNet and other URDF furniture: shapes, joints, metric scale, categories."""
