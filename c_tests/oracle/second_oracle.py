#!/usr/bin/env python3
"""A second oracle: checks the findings of dump_verdicts by Moeller-Trumbore in rationals, one ray and triangle at a time.

usage: second_oracle.py FILE    exits 1 with a line for each disagreement
"""

import json
import struct
import sys
from fractions import Fraction

UV_ERROR_PROMISED = Fraction(52, 100) / 2**24
INVALID_ID = 0xFFFFFFFF


def numbers(texts):
    return [float.fromhex(text) for text in texts]


def fractions(texts):
    return [Fraction(number) for number in numbers(texts)]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def float_bits(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


def float_of_bits(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def neighbour(value, step):
    """The float `step` places further from zero."""
    return float_of_bits(float_bits(value) + step)


def nearest_float(value):
    """The float nearest to a rational in the range of floats, ties to even."""
    guess = abs(struct.unpack("<f", struct.pack("<f", float(value)))[0])  # rounded twice: at most one float off
    near = [guess, neighbour(guess, 1)] + ([neighbour(guess, -1)] if guess > 0 else [])
    best = min(near, key=lambda f: (abs(Fraction(f) - abs(value)), float_bits(f) % 2))
    return -best if value < 0 else best


def float_spacing(value):
    """The distance between floats in the binade of a rational."""
    below = nearest_float(abs(value))
    if Fraction(below) > abs(value):
        below = neighbour(below, -1)
    return Fraction(neighbour(below, 1)) - Fraction(below)


class Hit:
    """The exact point, and its t rounded once."""

    def __init__(self, ids, t, u, v):
        self.ids, self.t, self.u, self.v = ids, t, u, v
        self.spacing = float_spacing(t)
        self.t_float = nearest_float(t)

    def order(self):
        return (self.t, self.ids)


def intersect(origin, direction, triangle):
    """(t, u, v) where the line meets the closed triangle in one point (Moeller, Trumbore 1997)."""
    a, ab, ac = triangle
    p = cross(direction, ac)
    determinant = dot(ab, p)
    if determinant == 0:
        return None
    s = minus(origin, a)
    u = dot(s, p) / determinant
    if u < 0 or u > 1:
        return None
    q = cross(s, ab)
    v = dot(direction, q) / determinant
    if v < 0 or u + v > 1:
        return None
    return dot(ac, q) / determinant, u, v


def all_hits(ray, triangles):
    origin, direction = fractions(ray["origin"]), fractions(ray["direction"])
    hits = []
    for ids, triangle in triangles:
        point = intersect(origin, direction, triangle)
        if point:
            hits.append(Hit(ids, *point))
    return sorted(hits, key=Hit.order)


def judge(interval, answer, hits):
    """What Oracle::judge() says for Contract::exact."""
    t_min, t_max = interval
    t, u, v = numbers([answer["t"], answer["u"], answer["v"]])
    ids = tuple(answer["ids"])
    is_hit = ids[0] != INVALID_ID
    counting = [hit for hit in hits if t_min <= hit.t_float <= t_max]
    closest = counting[0] if counting else None
    reported = next((hit for hit in hits if hit.ids == ids), None)
    verdict = {"missed": not is_hit and bool(counting), "false_hit": is_hit and reported not in counting,
               "wrong_primitive": False, "tie": False, "t_ulps": -1.0, "uv_error": -1.0}
    if reported in counting:
        verdict["wrong_primitive"] = reported.t_float > closest.t_float
        verdict["tie"] = reported.t_float == closest.t_float and reported is not closest
    if reported:
        t_error = abs(Fraction(t) - reported.t) / reported.spacing
        uv_error = max(abs(Fraction(u) - reported.u), abs(Fraction(v) - reported.v))
        verdict["t_ulps"], verdict["uv_error"] = float(t_error), float(uv_error) * 2**24
    is_right = reported is closest and (not is_hit if closest is None else t == closest.t_float and uv_error <= UV_ERROR_PROMISED)
    verdict["outside_contract"] = not is_right
    return verdict


def disagreements(scene):
    triangles = []
    for triangle in scene["triangles"]:
        a, b, c = map(fractions, triangle["vertices"])
        triangles.append((tuple(triangle["ids"]), (a, minus(b, a), minus(c, a))))
    for index, entry in enumerate(scene["rays"]):
        ray = entry["ray"]
        where = f"{scene['name']}, ray {index} {ray}"
        interval = numbers([ray["t_min"], ray["t_max"]])
        hits = all_hits(ray, triangles)
        found_hits = [(*hit["ids"], *numbers([hit["t"], hit["t_exact"]])) for hit in entry["hits"]]
        expected_hits = [(*hit.ids, hit.t_float, float(hit.t)) for hit in hits
                         if interval[0] <= hit.t_float <= interval[1]]
        if found_hits != expected_hits:
            yield f"{where}: hits {found_hits}, not {expected_hits}"
        for judged in entry["verdicts"]:
            expected = judge(interval, judged["answer"], hits)
            for field, value in expected.items():
                found = judged["verdict"][field]
                if isinstance(found, str):
                    found = float.fromhex(found)
                if found != value:
                    yield f"{where}: {judged['answer']}: {field} {found}, not {value}"


def main():
    if len(sys.argv) != 2:
        print(__doc__.splitlines()[2], file=sys.stderr)
        return 2
    with open(sys.argv[1], encoding="utf-8") as file:
        scenes = json.load(file)["scenes"]
    lines = [line for scene in scenes for line in disagreements(scene)]
    for line in lines:
        print(line)
    ray_count = sum(len(scene["rays"]) for scene in scenes)
    hit_count = sum(len(entry["hits"]) for scene in scenes for entry in scene["rays"])
    print(f"{ray_count} rays, {hit_count} hits: {len(lines)} disagreements")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
