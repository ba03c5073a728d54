"""What Blender takes for one frame of shapes and of shapes with an armature: the peer of `./dev bench evaluate whole`.

Usage: blender -b --factory-startup -P bench/blender/evaluate.py -- FACE.glb
Time of the process on all its threads, so that a busy machine does not count against Blender.
FACE.glb is what `build/bench_evaluate write FACE.glb` writes: the face of the benchmark with 62 shapes and 60 joints of 4
influences. Prints milliseconds, the minimum over frames; a frame changes every shape key (and every joint) and asks for the
evaluated mesh."""

import math
import sys
import time

try:
    import bpy
    import numpy
except ImportError:
    sys.exit("bench/blender/evaluate.py: run it inside Blender: blender -b --factory-startup -P bench/blender/evaluate.py -- FACE.glb")

if not hasattr(numpy, "bool"):  # Blender 3.4's importer asks for a name that NumPy has dropped
    numpy.bool = bool


def frame_seconds(change, mesh_object):
    best = math.inf
    for frame in range(100):
        change(frame)
        start = time.process_time()
        mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices[0].co.x
        best = min(best, time.process_time() - start)
    return best


def main(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    face = max((o for o in bpy.data.objects if o.type == "MESH"), key=lambda o: len(o.data.vertices))
    keys = face.data.shape_keys.key_blocks[1:] if face.data.shape_keys else []
    armature = next((o for o in bpy.data.objects if o.type == "ARMATURE"), None)

    def change_shapes(frame):
        for index, key in enumerate(keys):
            key.value = 0.5 + 0.4 * math.sin(frame + index)

    def change_all(frame):
        change_shapes(frame)
        for index, bone in enumerate(armature.pose.bones):
            bone.rotation_mode = "XYZ"
            bone.rotation_euler[0] = 0.1 * math.sin(frame + index)

    print(f"Blender {bpy.app.version_string}, {len(face.data.vertices)} vertices, {len(keys)} shapes")
    if armature:
        print(f"shapes and armature: {1e3 * frame_seconds(change_all, face):.2f} ms")
        for modifier in face.modifiers:
            modifier.show_viewport = False
    print(f"shapes: {1e3 * frame_seconds(change_shapes, face):.2f} ms")


main(sys.argv[sys.argv.index("--") + 1])
