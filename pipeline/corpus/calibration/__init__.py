"""The embedded corpus held against what is known of 3D-FRONT: counted house by house, shown line by line."""
