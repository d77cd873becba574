"""Sapling trees as a stranger would export them: every branch and leaf joined into one mesh without names, written by
Blender's own exporters; and the truth, one node per part with its parent, as NAME_truth.glb.

    blender -b --factory-startup --python tests/data/make_merged_trees.py [-- FOLDER]

Made with Blender 3.4.1 (Debian 12), Sapling 0.3.4. A branch's parent is the spline on whose middle line it starts, a
leaf's the one whose middle line its card's base is nearest to.
"""
import importlib.util
import os
import sys

import numpy

numpy.bool = bool  # Debian 12's numpy lacks what its Blender's glTF exporter names
import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
spec = importlib.util.spec_from_file_location("make_plants", os.path.join(HERE, "../../data/make_plants.py"))
plants = importlib.util.module_from_spec(spec)
spec.loader.exec_module(plants)

FOLDER = sys.argv[sys.argv.index("--") + 1] if "--" in sys.argv else HERE
TREES = {
    # Long shoots that wind through each other.
    "vine": dict(plants.APPLE, seed=13, levels=2, scale=1.5, ratio=0.006, length=(1, 0.7, 0.3, 0.3), minRadius=0.0012,
                 branches=(0, 20, 0, 0), curveRes=(12, 6, 1, 1), curveV=(260, 260, 0, 0), baseSize=0.05, leaves=9,
                 attractUp=(0, 0.3, 0, 0)),
    # Stems that fork: clones begin inside of the stem they leave, side by side.
    "forked": dict(seed=4, levels=3, shape="4", scale=4, ratio=0.02, length=(1, 0.4, 0.45, 0.3), branches=(0, 9, 5, 0),
                   curveRes=(8, 5, 3, 1), segSplits=(0.5, 0.3, 0.2, 0), splitAngle=(22, 30, 30, 0),
                   splitAngleV=(5, 5, 5, 0), curve=(0, -30, -20, 0), curveV=(30, 60, 60, 0),
                   downAngle=(90, 55, 45, 45), minRadius=0.002, leaves=8, baseSize=0.28, ratioPower=1.15, scaleV=0,
                   scaleV0=0),
}


def parent_or_none(branches, start):
    found = [(*plants.nearest_on(b["centres"], start), i) for i, b in enumerate(branches)]
    found = [(distance, i) for distance, at, i in found if at > 1e-3]
    return min(found)[1] if found else None


plants.parent_of = parent_or_none


def write_truth(path, name, branches, cards):
    glb = plants.Glb(name)
    for branch in branches:
        points = [plants.TO_GLTF @ p for p in branch["points"]]
        glb.json["nodes"].append(dict(name=branch["name"], mesh=glb.mesh(branch["name"], points, branch["triangles"], 0),
                                      extras=dict(liana=dict(kind="branch"))))
    for number, (quad, parent) in enumerate(cards):
        points = [plants.TO_GLTF @ p for p in quad]
        glb.json["nodes"].append(dict(name=f"leaf.{number}", mesh=glb.mesh(f"leaf.{number}", points, [(0, 1, 2), (0, 2, 3)], 1),
                                      extras=dict(liana=dict(kind="leaf"))))
    parents = [b["parent"] for b in branches] + [parent for _, parent in cards]
    for index, parent in enumerate(parents):
        if parent is not None:
            glb.json["nodes"][parent].setdefault("children", []).append(index)
    glb.write(path)


def write_merged(stem, branches, cards):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    points, faces = [], []
    for branch in branches:
        first = len(points)
        points += [tuple(p) for p in branch["points"]]
        faces += [tuple(v + first for v in t) for t in branch["triangles"]]
    for quad, _ in cards:
        faces.append(tuple(range(len(points), len(points) + 4)))
        points += [tuple(p) for p in quad]
    mesh = bpy.data.meshes.new("tree")
    mesh.from_pydata(points, [], faces)
    tree = bpy.data.objects.new("tree", mesh)
    bpy.context.scene.collection.objects.link(tree)
    bpy.context.view_layer.objects.active = tree
    tree.select_set(True)
    bpy.ops.wm.obj_export(filepath=stem + ".obj", export_uv=False, export_normals=False, export_materials=False)
    bpy.ops.export_mesh.ply(filepath=stem + ".ply", use_normals=False, use_uv_coords=False, use_ascii=False,
                            axis_forward="Y", axis_up="Z")
    # Flat shading: the exporter splits every vertex.
    bpy.ops.export_scene.gltf(filepath=stem + "_flat.glb", export_format="GLB", export_materials="NONE")


for name, sapling in TREES.items():
    curve, quads = plants.grow(sapling)
    branches = plants.branch_domains(curve, sides=6, steps=2)
    cards = [(q, min((plants.nearest_on(b["centres"], (q[0] + q[3]) / 2)[0], i) for i, b in enumerate(branches))[1])
             for q in quads]
    stem = os.path.join(FOLDER, name)
    write_truth(stem + "_truth.glb", name, branches, cards)
    write_merged(stem, branches, cards)
    print(f"{name}: {len(branches)} branches, {len(cards)} leaves")
