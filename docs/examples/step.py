#!/usr/bin/env python3
"""Attitudes from the frames of a recording (docs/onnx.md): step.py PREFIX frames.tslr"""
import struct
import sys

import numpy as np
import onnxruntime


def frames_of(data):
    """Time [s], field of view [rad], ranges [m], q_inertial_lrf of the chaser: docs/icd.md, 5. Recordings."""
    rays, count, at = *struct.unpack_from("<HI", data, 6), 12
    for _ in range(count):
        time_ns, _, fov_urad, _, _, *q_q30 = struct.unpack_from("<qIIBq4i", data, at)
        at, ranges_m = at + 41, np.zeros((rays, rays))
        for row in ranges_m:
            first, n = data[at], data[at + 1]
            row[first:first + n] = np.frombuffer(data, "<u2", n, at + 2) / 128
            at += 2 + 2 * n
        yield time_ns / 1e9, fov_urad / 1e6, ranges_m, np.array(q_q30) / 2**30


def points_of(ranges_m, fov_rad):
    """Points in the LiDAR's frame: +x right, +y boresight, +z up. A range of 0 is no return."""
    slope = np.tan(fov_rad / 2) * ((2 * np.arange(len(ranges_m)) + 1) / len(ranges_m) - 1)
    rays = np.stack(np.broadcast_arrays(slope, np.ones_like(ranges_m), -slope[:, None]), -1)
    points = rays * (ranges_m / np.linalg.norm(rays, axis=2))[..., None]
    return points.reshape(-1, 3).astype(np.float32)


def turn(now, last):
    """q_now_last, the Hamilton product of conjugate(q_inertial_lrf now) and q_inertial_lrf last."""
    (a, u), (b, v) = (now[0], -now[1:]), (last[0], last[1:])
    return np.array([[a * b - u @ v, *(a * v + b * u + np.cross(u, v))]], np.float32)


image_model, step_model = (onnxruntime.InferenceSession(f"{sys.argv[1]}.{name}.onnx") for name in ("image", "step"))
state, last = np.zeros((1, 451), np.float32), None
with open(sys.argv[2], "rb") as recording:
    for time_s, fov_rad, ranges_m, q in frames_of(recording.read()):
        last = last or (time_s, q)
        image, r_lrf_view = image_model.run(["image", "r_lrf_view"], {"points_lrf_m": points_of(ranges_m, fov_rad)})
        attitude, error_rad, state = step_model.run(["q_lrf_trf", "expected_error_rad", "next_state"], {
            "image": image, "r_lrf_view": r_lrf_view, "elapsed_s": np.array([[time_s - last[0]]], np.float32),
            "q_now_last": turn(q, last[1]), "state": state})
        last = time_s, q
        parts = " ".join(f"{part:.4f}" for part in attitude[0])
        print(f"{time_s:.2f} s  q_lrf_trf {parts}  error {error_rad[0, 0]:.4f} rad")
