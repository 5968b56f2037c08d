"""From Blender's scene to a folder with a scene file of Keyhole, its meshes and its pictures."""
