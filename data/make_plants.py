"""Makes the plants of data/plants with Blender's Sapling tree add-on, as segmented glTF files.

    blender -b --factory-startup --python data/make_plants.py

Every spline of Sapling's curve becomes one open tube, hung below the spline it starts on; every leaf that Sapling
places becomes one bent sheet, hung below its twig. The form is that of mesher/io/plant_file.h: a node is a domain,
parenting is attachment, metres, +Y up. Made with Blender 3.4.1 (Debian 12), Sapling 0.3.4.
"""
import json
import math
import os
import random
import struct

import addon_utils
import bpy
from mathutils import Matrix, Quaternion, Vector

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "plants")
TO_GLTF = Matrix(((1, 0, 0), (0, 0, 1), (0, -1, 0)))  # Blender is +Z up
LEVEL_NAMES = ("trunk", "branch", "twig", "spur")

APPLE = dict(
    shape="4", lengthV=(0, 0.1, 0.15, 0), curve=(0, -20, -15, 0), curveV=(25, 45, 50, 0), downAngle=(90, 68, 52, 45),
    downAngleV=(0, 28, 8, 10), baseSize=0.28, ratioPower=1.15, rootFlare=1.25, leafDownAngle=50, leafDownAngleV=15,
    attractUp=(0, 0.1, 0.2, 0), scaleV=0, scaleV0=0)

PLANTS = {
    "apple_small": dict(
        sapling=dict(APPLE, seed=11, levels=3, scale=1.7, ratio=0.014, length=(1, 0.5, 0.5, 0.3), minRadius=0.0018,
                     branches=(0, 9, 3, 0), curveRes=(8, 5, 4, 1), leaves=5),
        leaf=dict(lengths=(0.06, 0.07, 0.08), width=0.62, bend=0.5, fold=0.35, thickness=3e-4, base=0.22)),
    "apple_tree": dict(
        sapling=dict(APPLE, seed=5, levels=3, scale=2.9, ratio=0.016, length=(1, 0.55, 0.42, 0.3), minRadius=0.0018,
                     branches=(0, 22, 9, 0), curveRes=(10, 6, 4, 1), leaves=36),
        leaf=dict(lengths=(0.06, 0.07, 0.08), width=0.62, bend=0.5, fold=0.35, thickness=3e-4, base=0.22)),
    "ivy_sprig": dict(
        sapling=dict(APPLE, seed=3, levels=2, scale=0.6, ratio=0.008, length=(1, 0.6, 0.3, 0.3), minRadius=0.0015,
                     branches=(0, 12, 0, 0), curveRes=(10, 6, 1, 1), curveV=(120, 130, 0, 0), baseSize=0.1, leaves=6,
                     rootFlare=1.0, attractUp=(0, 0.8, 0, 0)),
        leaf=dict(lengths=(0.045, 0.055, 0.065), width=0.95, bend=0.4, fold=0.25, thickness=3e-4, base=0.25)),
}


def grow(settings):
    """Runs Sapling in an empty scene; returns its curve and, per leaf, the corners of the quad it placed."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("add_curve_sapling")
    random.seed(settings["seed"])
    bpy.ops.curve.tree_add(do_update=True, bevel=True, showLeaves=True, leafShape="rect", handleType="0", **settings)
    tree = next(o for o in bpy.data.objects if o.type == "CURVE")
    leaves = next(o for o in bpy.data.objects if o.type == "MESH").data
    quads = [[leaves.vertices[v].co.copy() for v in face.vertices] for face in leaves.polygons]
    return tree.data, quads


def tube(spline, sides, steps):
    """Blender's own bevel of one spline as an open tube: points, triangles and the centreline with its radii."""
    curve = bpy.data.curves.new("one", "CURVE")
    curve.dimensions, curve.fill_mode, curve.bevel_depth = "3D", "FULL", 1.0
    curve.bevel_resolution, curve.resolution_u, curve.use_fill_caps = (sides - 4) // 2, steps, False
    copy = curve.splines.new("BEZIER")
    copy.bezier_points.add(len(spline.bezier_points) - 1)
    for new, old in zip(copy.bezier_points, spline.bezier_points):
        new.co, new.radius, new.tilt = old.co, old.radius, old.tilt
        new.handle_left_type = new.handle_right_type = "FREE"
        new.handle_left, new.handle_right = old.handle_left, old.handle_right
    mesh = bpy.data.objects.new("one", curve).to_mesh()
    points = [v.co.copy() for v in mesh.vertices]
    triangles = []
    for face in mesh.polygons:
        a, b, c, d = face.vertices
        triangles += [(a, b, c), (a, c, d)]
    rings = [points[i:i + sides] for i in range(0, len(points), sides)]
    assert len(points) % sides == 0 and len(rings) >= 3, "the bevel is not made of rings"
    centres = [sum(ring, Vector()) / sides for ring in rings]
    radii = [(ring[0] - centre).length for ring, centre in zip(rings, centres)]
    return points, triangles, centres, radii


def nearest_on(centres, point):
    """Distance from a point to a polyline, and where along it: 0 at its start, len - 1 at its end."""
    best = (math.inf, 0.0)
    for i, (a, b) in enumerate(zip(centres, centres[1:])):
        t = max(0.0, min(1.0, (point - a).dot(b - a) / max((b - a).length_squared, 1e-18)))
        best = min(best, ((a.lerp(b, t) - point).length, i + t))
    return best


def parent_of(branches, start):
    """The earlier spline that a spline starts on; one that only shares its start is a sibling."""
    found = [(*nearest_on(b["centres"], start), i) for i, b in enumerate(branches)]
    found = [(distance, i) for distance, at, i in found if at > 1e-3]
    distance, parent = min(found)
    reach = max(branches[parent]["radii"])
    assert distance < max(reach, 2e-3), f"a branch starts {distance} m beside its parent"
    return parent


def branch_domains(curve, sides, steps):
    branches = []
    for spline in curve.splines:
        points, triangles, centres, radii = tube(spline, sides, steps)
        parent = parent_of(branches, centres[0]) if branches else None
        level = branches[parent]["level"] + 1 if branches else 0
        count = sum(b["parent"] == parent for b in branches) + 1
        path = branches[parent]["path"] + [count] if branches else []
        name = LEVEL_NAMES[min(level, 3)] + "".join(f".{n}" for n in path)
        branches.append(dict(name=name, path=path, kind="branch", parent=parent, level=level, points=points,
                             triangles=triangles, centres=centres, radii=radii, origin=centres[0]))
    return branches


def leaf_card(length, width, bend, fold, base, along=10, across=4):
    """A leaf's blade along +X, normal near +Z, the middle of its base at the origin; width relative to length."""
    points, triangles = [], []
    for j in range(along + 1):
        s = j / along
        if s < 0.4:
            outline = base + (1 - base) * math.sin(math.pi / 2 * s / 0.4)
        else:
            outline = 0.08 + 0.92 * math.cos(math.pi / 2 * (s - 0.4) / 0.6)
        angle = bend * s
        centre = Vector((math.sin(angle), 0, math.cos(angle) - 1)) * (length / bend)
        up = Vector((math.sin(angle), 0, math.cos(angle)))
        for i in range(across + 1):
            u = (i / across - 0.5) * outline * width * length
            points.append(centre + Vector((0, u * math.cos(fold), 0)) + up * (abs(u) * math.sin(fold)))
    for j in range(along):
        for i in range(across):
            a = j * (across + 1) + i
            triangles += [(a, a + across + 1, a + 1), (a + 1, a + across + 1, a + across + 2)]
    return points, triangles


def leaf_domains(branches, quads, lengths):
    """Places one of the sizes at each of Sapling's leaves, its base on the surface of the nearest thinnest branch."""
    leaves = []
    for number, (a, b, c, d) in enumerate(quads):
        base, along = (a + d) / 2, ((b + c) - (a + d)).normalized()
        distance, parent = min((nearest_on(br["centres"], base)[0], i) for i, br in enumerate(branches)
                               if br["level"] == max(x["level"] for x in branches))
        at = nearest_on(branches[parent]["centres"], base)[1]
        radii = branches[parent]["radii"]
        centres = branches[parent]["centres"]
        lower = min(int(at), len(radii) - 2)
        on_axis = centres[lower].lerp(centres[lower + 1], at - lower)
        radius = radii[lower] + (radii[lower + 1] - radii[lower]) * (at - lower)
        assert distance < 5e-3, f"a leaf hangs {distance} m beside its twig"
        across = (d - a) - along * (d - a).dot(along)
        normal = along.cross(across).normalized()
        if normal.z < 0:
            normal = -normal
        frame = Matrix((along, normal.cross(along), normal)).transposed()
        count = sum(leaf["parent"] == parent for leaf in leaves) + 1
        path = branches[parent]["path"] + [count]
        leaves.append(dict(name="leaf" + "".join(f".{n}" for n in path), kind="leaf", parent=parent,
                           origin=on_axis + along * (0.8 * radius), frame=frame, size=number % len(lengths)))
    return leaves


class Glb:
    """A glTF 2.0 document with one buffer."""

    def __init__(self, name):
        self.buffer = bytearray()
        self.json = dict(
            asset=dict(version="2.0", generator="Blender Sapling Tree Gen through data/make_plants.py",
                       copyright="Liana contributors, Apache-2.0"),
            scene=0, scenes=[dict(name=name, nodes=[0])], nodes=[], meshes=[], accessors=[], bufferViews=[],
            buffers=[dict()], materials=[
                dict(name="bark", pbrMetallicRoughness=dict(baseColorFactor=[0.30, 0.22, 0.15, 1],
                                                            metallicFactor=0, roughnessFactor=0.9)),
                dict(name="leaf", doubleSided=True,
                     pbrMetallicRoughness=dict(baseColorFactor=[0.13, 0.33, 0.08, 1], metallicFactor=0,
                                               roughnessFactor=0.6))])

    def accessor(self, data, target, **fields):
        self.json["bufferViews"].append(dict(buffer=0, byteOffset=len(self.buffer), byteLength=len(data), target=target))
        self.buffer += data + bytes(-len(data) % 4)
        self.json["accessors"].append(dict(bufferView=len(self.json["bufferViews"]) - 1, **fields))
        return len(self.json["accessors"]) - 1

    def mesh(self, name, points, triangles, material):
        local = [[struct.unpack("f", struct.pack("f", x))[0] for x in p] for p in points]
        position = self.accessor(
            b"".join(struct.pack("<3f", *p) for p in local), 34962, componentType=5126, type="VEC3", count=len(local),
            min=[min(p[k] for p in local) for k in range(3)], max=[max(p[k] for p in local) for k in range(3)])
        corners = [v for t in triangles for v in t]
        index = self.accessor(struct.pack(f"<{len(corners)}H", *corners), 34963, componentType=5123, type="SCALAR",
                              count=len(corners))
        self.json["meshes"].append(dict(name=name, primitives=[
            dict(attributes=dict(POSITION=position), indices=index, material=material)]))
        return len(self.json["meshes"]) - 1

    def write(self, path):
        self.json["buffers"][0]["byteLength"] = len(self.buffer)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as out:
            out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.buffer)))
            out.write(struct.pack("<I4s", len(text), b"JSON") + text)
            out.write(struct.pack("<I4s", len(self.buffer), b"BIN\0") + self.buffer)


def rounded(vector):
    return [round(x, 7) for x in vector]


def write_plant(name, branches, leaves, leaf):
    glb = Glb(name)
    sizes = []
    for number, length in enumerate(leaf["lengths"]):
        points, triangles = leaf_card(length, leaf["width"], leaf["bend"], leaf["fold"], leaf["base"])
        sizes.append(glb.mesh(f"leaf size {number + 1}", points, triangles, 1))
    for branch in branches:
        points = [TO_GLTF @ (p - branch["origin"]) for p in branch["points"]]
        origin = branch["origin"] - (branches[branch["parent"]]["origin"] if branch["path"] else Vector())
        glb.json["nodes"].append(dict(
            name=branch["name"], translation=rounded(TO_GLTF @ origin),
            mesh=glb.mesh(branch["name"], points, branch["triangles"], 0), extras=dict(liana=dict(kind="branch"))))
    for card in leaves:
        turn = (TO_GLTF @ card["frame"]).to_quaternion()
        glb.json["nodes"].append(dict(
            name=card["name"], mesh=sizes[card["size"]], rotation=[turn.x, turn.y, turn.z, turn.w],
            translation=rounded(TO_GLTF @ (card["origin"] - branches[card["parent"]]["origin"])),
            extras=dict(liana=dict(kind="leaf", thickness=leaf["thickness"]))))
    for index, domain in enumerate(branches + leaves):
        if domain["parent"] is not None:
            glb.json["nodes"][domain["parent"]].setdefault("children", []).append(index)
    glb.write(os.path.join(FOLDER, name + ".glb"))


if __name__ == "__main__":
    for name, plant in PLANTS.items():
        curve, quads = grow(plant["sapling"])
        branches = branch_domains(curve, sides=8 if plant["sapling"]["levels"] > 2 else 6, steps=2)
        leaves = leaf_domains(branches, quads, plant["leaf"]["lengths"])
        write_plant(name, branches, leaves, plant["leaf"])
        top = max(p.z for b in branches for p in b["points"])
        print(f"{name}: {len(branches)} branches on {1 + max(b['level'] for b in branches)} levels, {len(leaves)} leaves, "
              f"{top:.2f} m high, trunk {2000 * branches[0]['radii'][0]:.0f} mm, thinnest "
              f"{2000 * min(min(b['radii']) for b in branches):.1f} mm")
