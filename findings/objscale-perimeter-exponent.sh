#!/usr/bin/env bash
# Python package objscale 2.1.0 and 2.2.0: the exponent of the distribution of perimeters.
#
# Expected: 4 pictures with 4,000 separate discs each, of which 1/A are larger than an area A, have perimeters P of which
#           1/P^2 are longer than P. Both releases find about 2, and the same number for the same pictures.
# Seen: 2.1.0 finds 1.78 and 2.2.0 finds 2.13 with all settings at their defaults. For areas they find 0.95 and 0.92
#       where 1 was made: small discs of cells are no discs.
# Fails where that changes.
set -euo pipefail
dir="$(mktemp -d)"
trap 'rm -rf "$dir"' EXIT
cat > "$dir/discs.py" <<'PY'
import importlib.metadata
import warnings

import numpy
import objscale

warnings.simplefilter("ignore")
chance = numpy.random.default_rng(7)
SIDE, SMALLEST, LARGEST = 2048, 12, 12000


def picture():
    cells = numpy.zeros((SIDE, SIDE), dtype=numpy.uint8)
    taken = numpy.zeros((SIDE, SIDE), dtype=bool)
    least = SMALLEST / LARGEST
    areas = SMALLEST / (chance.random(4000) * (1 - least) + least)
    for radius in sorted(numpy.sqrt(areas / numpy.pi), reverse=True):
        room = int(radius + 3)
        for _ in range(60):
            y, x = chance.integers(room, SIDE - room, 2)
            square = (slice(y - room, y + room + 1), slice(x - room, x + room + 1))
            if not taken[square].any():
                rows, columns = numpy.ogrid[square]
                cells[square][(rows - y) ** 2 + (columns - x) ** 2 <= radius**2] = 1
                taken[square] = True
                break
    return cells


pictures = [picture() for _ in range(4)]
found = [objscale.finite_array_powerlaw_exponent(pictures, what) for what in ("area", "perimeter")]
print(importlib.metadata.version("objscale"), *(f"{number:.2f}" for number in found))
PY
for release in 2.1.0 2.2.0; do
    python3 -m venv "$dir/$release"
    "$dir/$release/bin/pip" --quiet --disable-pip-version-check install "objscale==$release" "numpy==2.4.6" \
        "scipy==1.17.1" "scikit-image==0.26.0" "numba==0.68.1"
    "$dir/$release/bin/python" "$dir/discs.py" | tee -a "$dir/said"
done
diff - "$dir/said" <<'SEEN' || { echo "objscale-perimeter-exponent: no longer so" >&2; exit 1; }
2.1.0 0.95 1.78
2.2.0 0.92 2.13
SEEN
echo "objscale-perimeter-exponent: as seen"
