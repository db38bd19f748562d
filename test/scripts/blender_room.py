# SPDX-License-Identifier: BSD-3-Clause
"""Makes a room in Blender, writes it in the formats that photonav reads, and opens a point cloud.

usage: blender -b --factory-startup --python-exit-code 1 --python blender_room.py -- FOLDER
The folder has surfaces.ply. Prints its number of points and its box.
"""

import sys

import bpy

folder = sys.argv[-1]


def tiles():
    """Eight by eight tiles of 0.8 and 0.2, but for a black one at the lower left."""
    image = bpy.data.images.new("tiles", 64, 64)
    pixels = []
    for y in range(64):
        for x in range(64):
            grey = 0.2 if (x // 8 + y // 8) % 2 else 0.8
            pixels += 3 * [0. if x < 8 and y < 8 else grey] + [1.]
    image.pixels = pixels
    image.filepath_raw, image.file_format = folder + "/tiles.png", "PNG"
    image.save()
    return image


def material(name, grey=None):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    colour = nodes["Principled BSDF"].inputs["Base Color"]
    if grey is None:
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = tiles()
        links.new(texture.outputs["Color"], colour)
    else:
        colour.default_value = (grey, grey, grey, 1.)
    return result


for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.mesh.primitive_plane_add(size=4, location=(2, 2, 0))
floor = bpy.context.object
floor.data.materials.append(material("floor"))
bpy.ops.mesh.primitive_cube_add(size=1, location=(3, 3, 0.5), scale=(1, 0.5, 2))
bpy.context.object.data.materials.append(material("box", 0.214))  # linear: 0.5 in an image
bpy.ops.export_scene.gltf(filepath=folder + "/room.glb", export_format="GLB")
bpy.ops.export_scene.gltf(filepath=folder + "/room.gltf", export_format="GLTF_SEPARATE")
bpy.ops.wm.obj_export(filepath=folder + "/room.obj", forward_axis="Y", up_axis="Z")
colours = floor.data.color_attributes.new("grey", "BYTE_COLOR", "CORNER")
for corner in colours.data:
    corner.color_srgb = (0.4, 0.4, 0.4, 1.)
bpy.ops.export_mesh.ply(filepath=folder + "/room.ply")

bpy.ops.import_mesh.ply(filepath=folder + "/surfaces.ply")
cloud = bpy.context.object
print("cloud", len(cloud.data.vertices), *cloud.bound_box[0], *cloud.bound_box[6])
