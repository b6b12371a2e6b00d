#!/usr/bin/env python3
"""Writes LiDAR frames of your own as a recording, and what is true beside it, for `tumblesight replay`.

    write_recording.py frames.tslr        writes frames.tslr and frames.truth.csv: ten frames of a spinning box
    tumblesight replay frames.tslr

Replace my_frames() by your data. docs/icd.md (4. LiDAR frames, 5. Recordings) says what a frame must be like.
"""
import math
import struct
import sys
import zlib

COUNTS_PER_METRE = 128  # ranges are unsigned Q9.7 metres in 16 bits
Q30 = 1 << 30


def ranges_of_points(points_lrf_m, rays, fov_rad):
    """Points in the LiDAR frame (LRF: +x right, +y boresight, +z up) as ranges, row by row from the top and each
    row from the left: the nearest point along each ray, 0 where there is none. Points that are not finite, as organised
    clouds have them where nothing returned, are no return."""
    tan_half = math.tan(fov_rad / 2)
    ranges_m = [[0.0] * rays for _ in range(rays)]
    for x, y, z in points_lrf_m:
        if not (y > 0 and math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
            continue
        column = math.floor((x / y / tan_half + 1) / 2 * rays)
        row = math.floor((1 - z / y / tan_half) / 2 * rays)
        if 0 <= row < rays and 0 <= column < rays:
            range_m = math.sqrt(x * x + y * y + z * z)
            if ranges_m[row][column] == 0 or range_m < ranges_m[row][column]:
                ranges_m[row][column] = range_m
    return ranges_m


def encoded_row(ranges_m):
    counts = [round(COUNTS_PER_METRE * m) if math.isfinite(m) else 0 for m in ranges_m]
    if not all(0 <= count <= 0xFFFF for count in counts):
        raise ValueError("ranges must be from 0 to 511.99 m; 0 is no return")
    hit = [column for column, count in enumerate(counts) if count]
    first, end = (hit[0], hit[-1] + 1) if hit else (0, 0)
    return struct.pack("<BB", first, end - first) + struct.pack(f"<{end - first}H", *counts[first:end])


def encoded_frame(frame):
    chaser = frame.get("q_inertial_lrf")  # w, x, y, z of the chaser at the exposure; None: not known
    parts = [round(Q30 * part) for part in chaser] if chaser else [0, 0, 0, 0]
    return struct.pack("<qIIBq4i", frame["exposure_time_ns"], frame["sequence_number"], round(1e6 * frame["fov_rad"]),
                       1 if chaser else 0, frame["exposure_time_ns"], *parts) + b"".join(
                           encoded_row(row) for row in frame["ranges_m"])


def write_recording(path, rays, frames):
    """Writes the frames, all with rays x rays ranges, in the order in which the sensor delivered them."""
    content = struct.pack("<4sHHI", b"TSLR", 2, rays, len(frames)) + b"".join(map(encoded_frame, frames))
    with open(path, "wb") as file:
        file.write(content + struct.pack("<I", zlib.crc32(content)))


def write_truth(path, frames):
    """Writes the true attitude of each frame that has one."""
    with open(path, "w", encoding="ascii") as file:
        file.write("sequence_number,exposure_time_ns,q_lrf_trf_w,q_lrf_trf_x,q_lrf_trf_y,q_lrf_trf_z\n")
        for frame in frames:
            if "q_lrf_trf" in frame:
                values = [frame["sequence_number"], frame["exposure_time_ns"], *frame["q_lrf_trf"]]
                file.write(",".join(map(repr, values)) + "\n")


def product(p, q):
    """Hamilton product of quaternions w, x, y, z."""
    return (p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0])


def rotated(q, v):
    return product(product(q, (0, *v)), (q[0], -q[1], -q[2], -q[3]))[1:]


def box_points(q_lrf_trf, distance_m):
    """Points on a box of 3 m x 2 m x 1 m at that distance along the boresight, in the LRF."""
    half = (1.5, 1.0, 0.5)
    steps = [i / 40 for i in range(-40, 41)]
    for axis in range(3):
        for side in (-1, 1):
            for a in steps:
                for b in steps:
                    unit = [a, b]
                    unit.insert(axis, side)
                    x, y, z = rotated(q_lrf_trf, [h * u for h, u in zip(half, unit)])
                    yield x, y + distance_m, z


def my_frames(rays):
    """Ten frames of a box that spins at 5 degrees per second, 2.7 s apart. The seventh is missing."""
    for number in range(10):
        if number == 6:
            continue
        turn = math.radians(5 * 2.7 * number)
        q = product((math.cos(turn / 2), 0, 0, math.sin(turn / 2)), (0.8, 0.6, 0, 0))
        fov = 2 * math.atan(2.0 / 20)  # the box fills most of it
        yield {"sequence_number": number, "exposure_time_ns": round(2.7e9 * number), "fov_rad": fov,
               "ranges_m": ranges_of_points(box_points(q, 20), rays, fov), "q_lrf_trf": q,
               "q_inertial_lrf": (1, 0, 0, 0)}


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: write_recording.py FRAMES.tslr")
    path = sys.argv[1]
    frames = list(my_frames(64))
    write_recording(path, 64, frames)
    write_truth(path.removesuffix(".tslr") + ".truth.csv", frames)


if __name__ == "__main__":
    main()
